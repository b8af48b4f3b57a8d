"""Parameters of the particle filter, by the names that gmapping gave them."""

from typing import Annotated

from msgspec import Meta

from uvf.models.keys import key
from uvf.models.params import Params

Share = Annotated[float, Meta(ge=0.0, le=1.0)]
Noise = Annotated[float, Meta(ge=0.0, le=2.0)]
Length = Annotated[float, Meta(gt=0.0)]


class RbpfParams(Params, frozen=True):
    """Parameters of ``RbpfSlam``."""

    particles: Annotated[int, Meta(ge=1, le=500), key("", "Particles; each has a path and a map.")] = 50
    linearUpdate: Annotated[float, Meta(gt=0.0, le=5.0), key("m", "Distance driven between updates of the particles.")] = 0.3
    angularUpdate: Annotated[float, Meta(gt=0.0, le=3.2), key("rad", "Angle turned between updates of the particles.")] = 0.25
    minimumScore: Annotated[
        float, Meta(ge=0.0), key("", "Sum over the beams of exp(-d^2 / 2 sigma^2) below which a match is rejected.")
    ] = 0.0
    maxUrange: Annotated[Length, key("m", "Longer beams are not used.")] = 80.0
    delta: Annotated[float, Meta(ge=0.01, le=0.5), key("m", "Cell size.")] = 0.05
    sigma: Annotated[float, Meta(ge=0.005, le=0.5), key("m", "1 sigma of a beam's end while a scan is matched.")] = 0.05
    lsigma: Annotated[float, Meta(ge=0.005, le=0.5), key("m", "1 sigma of a beam's end while particles are compared.")] = 0.03
    ogain: Annotated[float, Meta(ge=1.0, le=1000.0), key("", "Divisor of the log-likelihoods, for beams are not independent.")] = 120.0
    srr: Annotated[Noise, key("m/m", "1 sigma of the odometry's distance per distance.")] = 0.1
    srt: Annotated[Noise, key("m/rad", "1 sigma of the odometry's distance per turn.")] = 0.1
    str: Annotated[Noise, key("rad/m", "1 sigma of the odometry's turn per distance.")] = 0.1
    stt: Annotated[Noise, key("rad/rad", "1 sigma of the odometry's turn per turn.")] = 0.2
    resampleThreshold: Annotated[Share, key("", "Share of effective particles below which they are resampled.")] = 0.5
    mapMemory: Annotated[float, Meta(ge=10.0, le=100_000.0), key("MB", "Memory that the maps of all particles may take together.")] = 1000.0
    seed: Annotated[int, Meta(ge=0), key("", "Seed of the random numbers.")] = 1
