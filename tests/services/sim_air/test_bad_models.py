"""Mistakes in a JSBSim model end in one line that names the file, and in nothing that ends the process."""

import re
import shutil

import numpy as np
import pytest

from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
LEVEL = InitialState(np.array((0.0, 0.0, 60.0)), 0.0, 25.0, np.zeros(3))


def without(section):
    return rf"<{section}\b.*?</{section}>", ""


MISTAKES = {
    "no aerodynamics": (*without("aerodynamics"), "there is no <aerodynamics> section; add it"),
    "no metrics": (*without("metrics"), "there is no <metrics> section; add it"),
    "no mass": (*without("mass_balance"), "there is no <mass_balance> section; add it"),
    "no ground reactions": (*without("ground_reactions"), "there is no <ground_reactions> section; add it"),
    "no propulsion": (*without("propulsion"), "nothing makes the property 'fcs/throttle-pos-norm'; mend its name"),
    "an unknown property": ("aero/alpha-rad", "aero/alhpa-rad", "nothing makes the property 'aero/alhpa-rad'; mend its name"),
    "a broken tag": ("</metrics>", "</metrix>", "milvus.xml:21: not valid XML: mismatched tag"),
    "nothing": (".*", "", "milvus.xml:1: not valid XML: no element found"),
    "no XML": (".*", "\\\\x00\\\\x01", "milvus.xml:1: not valid XML"),
    "another kind of XML": (".*", "<sdf/>", "the outermost tag is <sdf>; a JSBSim model begins with <fdm_config>"),
    "a mass that is none": (r"> 11\.0 <", "> nan <", "mass_balance: emptywt is 'nan'; it must be a number above zero"),
    "no inertia": (r"> 0\.8244 <", "> 0 <", "mass_balance: ixx is '0'; it must be a number above zero"),
    "an inertia that no body has": (r"> 1\.759 <", "> 7.1 <", "izz is 7.1, more than ixx + iyy = 1.9594; no body has such inertia"),
    "an unknown unit": ('unit="KG"', 'unit="STONE"', 'JSBSim refuses it: Supplied unit: "STONE" does not exist'),
    "a function named twice": ("aero/total/CY", "aero/total/CD", "milvus.xml: JSBSim refuses it: Error loading aerodynamic function"),
    "an engine that is not there": ("milvus_motor", "milvus_moter", "no engine/milvus_moter.xml for the engine; did you mean 'milvus_m"),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_is_one_line(tmp_path, case):
    old, new, why = MISTAKES[case]
    folder = shutil.copytree(ROOT / "vehicles" / "milvus", tmp_path / "milvus")
    path = folder / "milvus" / "milvus.xml"
    text, count = re.subn(old, new, path.read_text(), count=0 if "property" in case else 1, flags=re.DOTALL)
    assert count
    path.write_text(text)
    with pytest.raises(BadInput) as caught:
        Airframe(folder, load_vehicle(tmp_path, "milvus").air, TANGENT).start(LEVEL)
    assert why in str(caught.value) and str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
