"""The one tree of an SDF file: every <include> replaced by the model it names, wherever that lies on this machine."""

import copy
import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from lxml import etree

from uvf.models.importing.notes import Notes
from uvf.models.importing.sdf.poses import FILE, place_of
from uvf.models.lfs_pointer import refuse_pointer
from uvf.models.yaml_data import BadInput

PATHS = ("GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH")
FUEL = (".gz/fuel", ".ignition/fuel")
GROUND = "ground_plane"
NOT_NEEDED = {"sun": "lights are not simulated", GROUND: "the ground, z = 0, is always there"}
LATE_DECLARATION = re.compile(rb"\A(\s+)<\?xml[^>]*\?>")
"""One that is not at the very beginning, where XML wants it: Gazebo does not mind."""
DEEPEST = 20  # models within models
PARENTS_SEARCHED = 4


def read_sdf(path: Path) -> Any:
    """The root element of an SDF file. Raises BadInput."""
    refuse_pointer(path)
    try:
        text = LATE_DECLARATION.sub(rb"\1", path.read_bytes())
        root = etree.fromstring(text, etree.XMLParser(remove_comments=True, remove_pis=True, resolve_entities=False))
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    except (etree.XMLSyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None) or 1
        raise BadInput(f"{path}:{line}: not valid XML: {' '.join(str(error).split())}; mend the tag there") from error
    if root.tag not in ("sdf", "gazebo"):
        raise BadInput(f"{path}: the root is <{root.tag}>, not <sdf>; give a Gazebo world or model")
    root.set(FILE, str(path))
    return root


class Models:
    """Finds models and their meshes: about the file, in ``folders``, in Gazebo's variables and caches."""

    def __init__(self, path: Path, folders: Sequence[Path], notes: Notes) -> None:
        about = [path.resolve().parent, *list(path.resolve().parents)[1:PARENTS_SEARCHED]]
        named = [Path(p) for variable in PATHS for p in os.environ.get(variable, "").split(":") if p]
        gazebo = [Path.home() / ".gazebo/models", *sorted(Path("/usr/share").glob("gazebo*/models"))]
        self._roots = [root for folder in (*folders, *about, *named, *gazebo) for root in (folder, folder / "models", folder / "worlds")]
        self._notes = notes
        self.names_ground = False
        """Whether Gazebo's own ground plane is included."""

    def expand(self, element: Any, depth: int = 0) -> None:
        """Replaces every <include> below ``element`` by its model. Raises BadInput for a file that is found and cannot be read."""
        if depth > DEEPEST:
            raise BadInput(f"{place_of(element)}: models include each other without end; cut the ring")
        for child in list(element):
            if child.tag == "include":
                model = self._included(child)
                element.remove(child) if model is None else element.replace(child, model)
                child = model
            if child is not None and child.tag in ("world", "model"):
                self.expand(child, depth + 1)
        _number(element)

    def _included(self, include: Any) -> Any:
        """A copy of the model, with the name and pose that the <include> gives it; None when it is not needed or not found."""
        uri = (include.findtext("uri") or "").strip()
        name = re.sub(r"[ -]", "_", _last(uri)).lower()
        if name in NOT_NEEDED:
            self.names_ground = self.names_ground or name == GROUND
            self._notes.add(f"not needed, for {NOT_NEEDED[name]}", f"model {_last(uri)}")
            return None
        found = self._model_file(uri, include)
        if found is None:
            hint = "download it and give its folder with --models" if "://fuel" in uri or uri.startswith("http") else "give --models"
            self._notes.add(f"models not found on this machine ({hint})", uri)
            return None
        root = read_sdf(found)
        model = copy.deepcopy(next(root.iter("model"), None))
        if model is None:
            kind = next((tag for tag in ("light", "actor") if root.find(tag) is not None), "nothing")
            self._notes.add(f"included files without a model (there is {kind} in it)", uri)
            return None
        model.set(FILE, str(found))
        _lay_over(model, include)
        return model

    def _model_file(self, uri: str, include: Any) -> Path | None:
        found = self.find(uri, include)
        if found is None or found.is_file():
            return found
        config = found / "model.config"
        if config.is_file():
            names = [e for e in _config(config).iter("sdf") if e.text]
            names.sort(key=lambda e: [int(n) for n in re.findall(r"\d+", e.get("version", "0"))])
            return next((p for e in reversed(names) if (p := found / e.text.strip()).is_file()), None)
        return next((p for p in (found / "model.sdf", *sorted(found.glob("*.sdf"))) if p.is_file()), None)

    def find(self, uri: str, user: Any) -> Path | None:
        """The file or folder that a URI stands for, as the element ``user`` writes it; None where it is not found."""
        return next((p for p in self._tries(uri.strip(), user) if p.exists()), None)

    def _tries(self, uri: str, user: Any) -> Iterator[Path]:
        beside = Path(place_of(user).rpartition(":")[0]).resolve().parent
        scheme, _, rest = uri.rpartition("://")
        rest = unquote(rest).strip("/") if scheme not in ("", "file") else unquote(rest)
        if scheme in ("http", "https"):
            yield from self._fuel(rest)
            return
        yield beside / rest
        for root in (*self._roots, beside.parent, beside.parent.parent):
            yield root / rest.lstrip("/")
            first, _, inside = rest.strip("/").partition("/")
            if root.name == first:
                yield root / inside

    def _fuel(self, rest: str) -> Iterator[Path]:
        """A model of Gazebo's on-line library, host/version/owner/models/NAME[/version[/files/...]]: in its cache or anywhere by name."""
        host, *parts = rest.split("/")
        if "models" not in parts or parts[-1] == "models":
            return
        at = parts.index("models")
        owner, name, inside = (
            parts[at - 1],
            parts[at + 1],
            "/".join(p for p in parts[at + 2 :] if not p.isdigit() and p not in ("tip", "files")),
        )
        for cache in FUEL:
            versions = (Path.home() / cache / host / owner.lower() / "models" / name.lower()).glob("*")
            yield from (folder / inside for folder in sorted(versions, reverse=True))
        for root in self._roots:
            yield from (folder / inside for folder in _called(root, name))


def _called(root: Path, name: str) -> Iterator[Path]:
    """Folders of that name, however its case and blanks are written."""
    plain = re.sub(r"[ _-]", "", name).lower()
    if root.is_dir():
        yield from sorted(p for p in root.iterdir() if p.is_dir() and re.sub(r"[ _-]", "", p.name).lower() == plain)


def _number(element: Any) -> None:
    """Models of the same name in one place are told apart as Gazebo does it: table, table_0, table_1."""
    seen: set[str] = set()
    for model in element.findall("model"):
        name = model.get("name") or "model"
        free = next(n for n in (name, *(f"{name}_{i}" for i in range(len(seen) + 1))) if n not in seen)
        model.set("name", free)
        seen.add(free)


def _config(path: Path) -> Any:
    """People's descriptions have a bare & in them; only the file's name is of use here, so what can be read is."""
    try:
        root = etree.fromstring(path.read_bytes(), etree.XMLParser(recover=True, resolve_entities=False))
        if root is None:
            raise ValueError("nothing in it")
        return root
    except (etree.XMLSyntaxError, ValueError) as error:
        raise BadInput(f"{path}: not valid XML: {' '.join(str(error).split())}; mend it") from error


def _last(uri: str) -> str:
    """The model's name in a URI."""
    parts = [unquote(p) for p in uri.rstrip("/").split("/") if p]
    while parts and (parts[-1].isdigit() or parts[-1] in ("tip", "model.sdf")):
        parts.pop()
    return parts[-1] if parts else uri


def _lay_over(model: Any, include: Any) -> None:
    """Name, pose, static and placement frame of the <include> count instead of the model's own."""
    if (include.findtext("name") or "").strip():
        model.set("name", include.findtext("name").strip())
    for tag in ("pose", "static"):
        new = include.find(tag)
        if new is not None:
            for old in model.findall(tag):
                model.remove(old)
            model.append(copy.deepcopy(new))
    frame = (include.findtext("placement_frame") or "").strip()
    if frame:
        model.set("placement_frame", frame)
    if include.get("merge", "false").strip().lower() in ("true", "1"):
        model.set("uvf_merged", "true")
