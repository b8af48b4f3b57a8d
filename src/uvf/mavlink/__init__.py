"""MAVLink: messages, frames and their limits. ``uvf.mavlink.dialect`` is generated; here is made sure that there is one."""

from uvf.mavlink.generate import PACKAGE, dialect_folder

if (_folder := dialect_folder()) != PACKAGE:
    __path__.insert(0, str(_folder))
