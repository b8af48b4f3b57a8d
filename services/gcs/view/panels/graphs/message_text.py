"""A message as lines of its fields, short enough for a panel whatever it holds."""

from google.protobuf.message import DecodeError
from google.protobuf.text_format import MessageToString

from services.gcs.state.graph.traffic import SHOWN_MOST, KeyTraffic
from uvf.runtime.messages.topic_lookup import topic_of
from uvf.runtime.messages.validation import legible

MOST_LINES, LINE = 60, 100
ALIKE = 3  # lines of one repeated field that are shown


def message_text(heard: KeyTraffic) -> str:
    """The newest message of a key, a field a line; what cannot be read is told in one line."""
    topic = topic_of(heard.key)
    if heard.payload is None:
        return f"{heard.size} bytes: more than the {SHOWN_MOST} that are shown here"
    if topic is None:
        return f"{heard.size} bytes of {heard.type_name or 'unknown type'}"
    try:
        message = topic.message.FromString(heard.payload)
    except DecodeError as error:
        return f"broken {heard.type_name}: {legible(str(error), LINE)}"
    return "\n".join(shortened(MessageToString(message).splitlines()))


def shortened(lines: list[str]) -> list[str]:
    """The lines, cut, with long runs of one field told by their number; at most ``MOST_LINES``."""
    kept: list[str] = []
    field, run = "", 0
    for line in lines:
        name = line.partition(":")[0] if ":" in line else ""
        if run > ALIKE and name != field:
            kept.append(f"{' ' * (len(field) - len(field.lstrip()))}… and {run - ALIKE} more")
        run = run + 1 if name and name == field else 1
        field = name
        if run <= ALIKE:
            kept.append(line if len(line) <= LINE else f"{line[: LINE - 1]}…")
        if len(kept) >= MOST_LINES:
            return [*kept, "…"]
    if run > ALIKE:
        kept.append(f"… and {run - ALIKE} more")
    return kept or ["(all fields have their default values)"]
