"""Things of a colour in pictures, and where they stand in the world."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.vision.blobs import Blob as Blob
    from uvf.vision.blobs import ColourRange as ColourRange
    from uvf.vision.blobs import colour_blobs as colour_blobs
    from uvf.vision.marker_map import Marker as Marker
    from uvf.vision.marker_map import MarkerMap as MarkerMap
    from uvf.vision.marker_map import MarkerModel as MarkerModel
    from uvf.vision.marker_map import Sighting as Sighting

OFFERED = {
    "colour_blobs": "uvf.vision.blobs:colour_blobs",
    "ColourRange": "uvf.vision.blobs:ColourRange",
    "Blob": "uvf.vision.blobs:Blob",
    "MarkerMap": "uvf.vision.marker_map:MarkerMap",
    "MarkerModel": "uvf.vision.marker_map:MarkerModel",
    "Sighting": "uvf.vision.marker_map:Sighting",
    "Marker": "uvf.vision.marker_map:Marker",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
