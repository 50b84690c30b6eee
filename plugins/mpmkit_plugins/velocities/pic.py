"""PIC: particles take the nodal velocity itself."""

from mpmkit.contracts import Operations, VelocityUpdate, hookimpl


class PIC(VelocityUpdate):
    """v ← ṽ: free of noise, at the price of a viscosity of about dx²/dt that grows as the step shrinks."""

    name = "pic"
    api_version = 2
    citation = "Harlow, Methods Comput. Phys. 3 (1964) 319-343"

    def cautions(self, case) -> list[str]:
        return ["velocity 'pic' damps like a viscosity of Δx²/Δt, more the smaller the step; 'apic' does not"]

    def map_to_particles(self, ops: Operations, dt: float) -> None:
        ops.move_particles(dt, flip=0.0)


@hookimpl
def mpmkit_velocity_updates():
    return [PIC]
