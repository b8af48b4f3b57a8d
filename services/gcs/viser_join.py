"""Keeps a page that joins late from stopping the others.

viser 1.1.1 walks over every message number ever given to find the few messages that still count: 0.2 s without any
other work for each million ever sent, so a day of flying would stop all pages for seconds. The walk is made to jump
over the gaps.
"""

import inspect
import textwrap
from bisect import bisect_left

from viser.infra import _async_message_buffer as module
from viser.infra._async_message_buffer import AsyncMessageBuffer

STEP = "                last_sent_id += 1\n"
JUMP = "                last_sent_id = next_live_id(self, last_sent_id + 1, most_recent_message_id)\n"


def next_live_id(buffer: AsyncMessageBuffer, wanted: int, newest: int) -> int:
    """The lowest number from ``wanted`` to ``newest`` that a message still has, or ``newest``."""
    if wanted in buffer.message_from_id or not buffer.persistent_messages:
        return wanted
    with buffer.buffer_lock:
        ids = list(buffer.message_from_id)  # a dict keeps the order of entry, and numbers only grow
    at = bisect_left(ids, wanted)
    return min(ids[at], newest) if at < len(ids) else newest


def apply() -> bool:
    """Replaces viser's loop by one that jumps; False (and viser as it is) when its source is not the known one."""
    if getattr(AsyncMessageBuffer._window_loop, "jumps", False):
        return True
    source = textwrap.dedent(inspect.getsource(AsyncMessageBuffer._window_loop))
    if source.count(STEP) != 1:
        return False
    names = vars(module) | {"next_live_id": next_live_id}
    exec(compile(source.replace(STEP, JUMP), module.__file__, "exec"), names)
    loop = names["_window_loop"]
    loop.jumps = True
    AsyncMessageBuffer._window_loop = loop  # type: ignore[method-assign]
    return True
