"""Component metadata: files that tell a ground station what each parameter means, offered over MAVLink FTP.

After the component metadata protocol of the MAVLink guide; forms as in ``general.schema.json`` and ``parameter.schema.json`` of
mavlink/mavlink. Without them QGroundControl would show PX4's own texts.
"""

import json
import lzma
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec

from services.autopilot.mavlink.connection.facts import VehicleInfo
from services.autopilot.mavlink.parameters.parameter_table import Parameter
from services.autopilot.mavlink.parameters.parameter_values import crc32
from services.autopilot.mavlink.telemetry.identity import VERSION
from uvf.mavlink import dialect as mav

FOLDER = "/etc/extras"
FORMAT = 1  # of both files: the only one that QGroundControl reads
COARSE = 30.0  # numbers that become so large need few decimals


def general_of(system_id: int) -> str:
    """Path of the general file. QGroundControl caches downloads by name: with one name for all it mixes vehicles up."""
    return f"{FOLDER}/general_{system_id}.json"


def parameters_file_of(system_id: int) -> str:
    """Path of the compressed parameter file."""
    return f"{FOLDER}/parameters_{system_id}.json.xz"


def files_of(facts: VehicleInfo, table: Sequence[Parameter]) -> dict[str, bytes]:
    """Content of both files by path; reproducible for a given vehicle."""
    own = msgspec.to_builtins(facts.params)
    told = {"version": FORMAT, "parameters": [described(p, own) for p in table]}
    # Small decoders know CRC-32 alone as the check of an xz stream.
    parameters = lzma.compress(_json(told), check=lzma.CHECK_CRC32)
    path = parameters_file_of(facts.system_id)
    types = [{"type": mav.COMP_METADATA_TYPE_PARAMETER, "uri": f"mftp://{path}", "fileCrc": crc32(parameters)}]
    general = {
        "version": FORMAT,
        "vendorName": "UVF",
        "modelName": facts.name,
        "firmwareVersion": ".".join(map(str, VERSION)),
        "metadataTypes": types,
    }
    return {general_of(facts.system_id): _json(general), path: parameters}


def described(p: Parameter, own: Mapping[str, Any]) -> dict[str, Any]:
    """The entry of one parameter; its default is the value of the vehicle's file."""
    entry: dict[str, Any] = {
        "name": p.name,
        "type": "Int32" if p.is_int else "Float",
        "shortDesc": p.about[:1].upper() + p.about[1:],
        "group": p.group,
        "category": "Standard",
        "default": p.number(own),
    }
    if p.fixed:
        entry |= {"longDesc": f"Fixed in this simulator: {p.fixed}.", "readOnly": True}
    elif not p.cases:
        entry |= {"min": p.low, "max": p.high}
    if says := {**p.means, **{number: case.says for number, case in p.cases.items()}}:
        entry["values"] = [{"value": number, "description": text} for number, text in says.items()]
    if p.unit:
        entry["units"] = p.unit
    if not p.is_int:
        entry["decimalPlaces"] = 2 if p.high > COARSE else 5
    return entry


def component_metadata(facts: VehicleInfo, files: Mapping[str, bytes], boot_ms: int) -> mav.MAVLink_component_metadata_message:
    """COMPONENT_METADATA, which names the general file and its CRC-32; boot_ms: time since boot [ms]."""
    general = general_of(facts.system_id)
    return mav.MAVLink_component_metadata_message(boot_ms, crc32(files[general]), f"mftp://{general}".encode())


def _json(data: object) -> bytes:
    return json.dumps(data, separators=(",", ":")).encode()
