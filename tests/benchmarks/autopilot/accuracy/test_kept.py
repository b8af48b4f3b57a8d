"""Figures of flights are kept between runs of a benchmark."""

import pytest

from benchmarks.autopilot.accuracy import kept
from uvf.models.scenario import ROOT


def test_what_has_been_flown_is_kept_until_its_sources_change(tmp_path, monkeypatch):
    flown = []

    def fly(seed):
        flown.append(seed)
        return {"seed": seed}

    monkeypatch.setattr(kept, "FOLDER", tmp_path)
    assert [kept.figures_of(fly, (seed,)) for seed in (1, 2, 1)] == [{"seed": 1}, {"seed": 2}, {"seed": 1}]
    assert flown == [1, 2]
    monkeypatch.setattr(kept, "_sources", lambda own: "changed")
    kept.figures_of(fly, (1,))
    assert flown == [1, 2, 1]


@pytest.mark.parametrize("part", kept.PARTS)
def test_every_source_is_there(part):
    assert (ROOT / part).exists()
