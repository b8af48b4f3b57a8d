"""Generates ``schemas/v1`` from ``schemas/proto``: ``python -m schemas.generate [--check]``."""

import re
import sys
import tempfile
from pathlib import Path

from foxglove_schemas_protobuf import Color_pb2, Grid_pb2, PackedElementField_pb2, Pose_pb2, Quaternion_pb2, Vector2_pb2, Vector3_pb2
from google.protobuf import timestamp_pb2
from google.protobuf.descriptor_pb2 import FileDescriptorSet

HERE = Path(__file__).parent
IMPORTED = (timestamp_pb2, Vector2_pb2, Vector3_pb2, Quaternion_pb2, Color_pb2, Pose_pb2, PackedElementField_pb2, Grid_pb2)


def generate(scratch: Path) -> dict[str, str]:
    """Runs protoc over every .proto file and returns the made files, name to text."""
    from grpc_tools import protoc

    # foxglove's package ships no .proto files, only modules that carry their descriptors.
    files = FileDescriptorSet()
    for module in IMPORTED:
        module.DESCRIPTOR.CopyToProto(files.file.add())
    (scratch / "imports.binpb").write_bytes(files.SerializeToString())
    arguments = [
        "protoc",
        f"--descriptor_set_in={scratch / 'imports.binpb'}",
        f"-I{HERE / 'proto'}",
        f"--python_out={scratch}",
        f"--pyi_out={scratch}",
        *sorted(str(p) for p in (HERE / "proto").rglob("*.proto")),
    ]
    if protoc.main(arguments) != 0:
        raise SystemExit("schemas.generate: protoc refused a .proto file; its message stands above")
    return {p.name: _mend_imports(p.read_text()) for p in sorted((scratch / "uvf/v1").iterdir())}


def _mend_imports(text: str) -> str:
    own = re.sub(r"from uvf\.v1 import", "from schemas.v1 import", text)
    return re.sub(r"from foxglove import", "from foxglove_schemas_protobuf import", own)


def main() -> None:
    """Writes the generated files, or with ``--check`` only compares them."""
    with tempfile.TemporaryDirectory() as scratch:
        made = generate(Path(scratch))
    out = HERE / "v1"
    if "--check" in sys.argv:
        old = [name for name, text in made.items() if not (out / name).exists() or (out / name).read_text() != text]
        extra = {p.name for p in out.glob("*_pb2.py*")} - made.keys()
        if old or extra:
            raise SystemExit(f"schemas: not up to date: {[*old, *sorted(extra)]}; run python -m schemas.generate")
        return
    for name, text in made.items():
        (out / name).write_text(text)


if __name__ == "__main__":
    main()
