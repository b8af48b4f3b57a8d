"""Things of a colour in pictures, and where they stand in the world."""

from uvf.vision.colour_blobs import Blob, ColourRange, colour_blobs
from uvf.vision.marker_map import Marker, MarkerMap, MarkerModel, Sighting

__all__ = ["Blob", "ColourRange", "Marker", "MarkerMap", "MarkerModel", "Sighting", "colour_blobs"]
