"""Layers of a directed graph follow its flow, cycles or not."""

from uvf.maths.graph_layers import arranged, flow_order, layers


def test_a_chain_with_a_shortcut_is_layered_by_its_longest_path():
    edges = dict.fromkeys([("a", "b"), ("b", "c"), ("c", "d"), ("a", "d")], 1.0)
    assert layers("dcba", edges) == {"a": 0, "b": 1, "c": 2, "d": 3}


def test_of_a_cycle_the_lightest_edge_leads_back():
    edges = {("sim", "slam"): 5.0, ("slam", "planner"): 2.0, ("planner", "pilot"): 2.0, ("pilot", "sim"): 1.0}
    assert layers(["pilot", "planner", "slam", "sim"], edges) == {"sim": 0, "slam": 1, "planner": 2, "pilot": 3}


def test_an_edge_to_itself_and_a_node_without_edges_change_nothing():
    assert layers(["a", "b", "lone"], {("a", "a"): 9.0, ("a", "b"): 1.0}) == {"a": 0, "b": 1, "lone": 0}


def test_every_node_is_ordered_once_whatever_the_edges():
    names = [f"n{i}" for i in range(12)]
    edges = {(a, b): 1.0 + (i * j) % 5 for i, a in enumerate(names) for j, b in enumerate(names) if (3 * i + 5 * j) % 4}
    assert sorted(flow_order(names, edges)) == sorted(names)
    assert sorted(name for row in arranged(layers(names, edges), edges) for name in row) == sorted(names)


def test_rows_are_arranged_so_that_parallel_edges_do_not_cross():
    edges = dict.fromkeys([("a", "z"), ("b", "y"), ("c", "x")], 1.0)
    first, second = arranged(layers("abcxyz", edges), edges)
    assert [dict(edges)[pair] for pair in zip(first, second, strict=True)] == [1.0, 1.0, 1.0]


def test_nothing_has_no_layers():
    assert arranged(layers([], {}), {}) == []
