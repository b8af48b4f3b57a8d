"""Parameters of the particle filter, by the names that gmapping gave them."""

from typing import Annotated

from msgspec import Meta

from uvf.models.params import Params

Share = Annotated[float, Meta(ge=0.0, le=1.0)]
Noise = Annotated[float, Meta(ge=0.0, le=2.0)]
Length = Annotated[float, Meta(gt=0.0)]


class RbpfParams(Params, frozen=True):
    particles: Annotated[int, Meta(ge=1, le=500)] = 50
    linearUpdate: Annotated[float, Meta(gt=0.0, le=5.0)] = 0.3  # m driven between updates of the particles
    angularUpdate: Annotated[float, Meta(gt=0.0, le=3.2)] = 0.25  # rad turned, the same
    minimumScore: Annotated[float, Meta(ge=0.0)] = 0.0  # sum over the beams of exp(-d^2 / 2 sigma^2), below which a match is not believed
    maxUrange: Length = 80.0  # m, beams that are longer are not used
    delta: Annotated[float, Meta(ge=0.01, le=0.5)] = 0.05  # m, side of a cell
    sigma: Annotated[float, Meta(ge=0.005, le=0.5)] = 0.05  # m, of a beam's end while a sweep is matched
    lsigma: Annotated[float, Meta(ge=0.005, le=0.5)] = 0.03  # m, the same where particles are compared
    ogain: Annotated[float, Meta(ge=1.0, le=1000.0)] = 120.0  # what log-likelihoods are divided by: beams are not independent
    srr: Noise = 0.1  # m per m, 1 sigma of the odometry's way by the way driven
    srt: Noise = 0.1  # m per rad, of its way by the turn
    str: Noise = 0.1  # rad per m, of its turn by the way driven
    stt: Noise = 0.2  # rad per rad, of its turn by the turn
    resampleThreshold: Share = 0.5  # part of the particles below which the effective ones are resampled
    mapMemory: Annotated[float, Meta(ge=10.0, le=100_000.0)] = 1000.0  # MB that the maps of all particles may take together
    seed: Annotated[int, Meta(ge=0)] = 1
