"""Names that were others once: who still writes the old one is told the new one."""

RENAMED = {
    "comfort": "inflation_radius",
    "dislike": "cost_scaling_factor",
    "least_frontier": "min_frontier_size",
    "frontier_worth": "frontier_gain",
}
"""Old -> new, of parameters and of keys of files."""
