"""PIC: particles take the nodal velocity itself."""

from mpmkit.contracts import Operations, VelocityUpdate, hookimpl


class PIC(VelocityUpdate):
    """v ← ṽ: free of noise, at the price of a viscosity of about dx²/dt that grows as the step shrinks."""

    name = "pic"
    api_version = 1
    citation = "Harlow, Methods Comput. Phys. 3 (1964) 319-343"

    def map_to_particles(self, ops: Operations, dt: float) -> None:
        ops.advance(dt, flip=0.0)


@hookimpl
def mpmkit_velocity_updates():
    return [PIC]
