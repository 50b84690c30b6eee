"""Impulses that the faces of the grid give to the material, at their nodes and through their ghosts.

In a step, the momentum of the particles changes by Σ m Δv over all nodes, ghosts included, with the masses
that the particles have put there. Forces inside the material and the weight give Δt Σ f. Faces and walls give
the rest. A ghost of mass m and force f is folded onto its image, with the sign s of each component, and then
filled with s Δv of that image. Together this adds

    m Δv_ghost - Δt f   at the ghost,   and   Δt s f - m Δv_image   at its image,

in sum (s - 1)(m Δv_image + Δt f). A node in the plane of a face that is held adds m times the change of its
velocity. During mapping, v takes the place of Δv, and the momentum p that of Δt f.

The faces are folded one after the other, and filled in the opposite order. So at an edge each face counts the
change of what the faces before it have left, and the sum over all faces is exact.

``given`` (width,) are the sums of one face: impulse, N s, (dim,), its moment about the origin of the scene,
N m s, (3,) or (1,), and its work, J, which is zero: faces stand still. ``place`` (n, dim) is that of the node
of the face between ghost and image, m. ``held`` (n, NODE) is the record of each ghost as it was before the
fold; its entry ``FATE`` says what was done with it.
"""

from __future__ import annotations

from .compile import function, inline
from .scatter import CONTACT

FATE = CONTACT
"""Entry of a held record: FOLDED, LEFT if the face did not act, or 0 if the ghost was empty."""
FOLDED, LEFT = 1.0, -1.0


@inline()
def _acts(nodes, wall, acting):
    return not acting or int(nodes[wall, CONTACT]) & acting


@inline()
def _turn(given, dim, a, lever, d, impulse):
    """Add the moment of an impulse along axis d at a distance along axis a, another one: e_a × e_d."""
    if dim == 2:  # about the axis out of the plane: z × x = y
        given[2] += lever * impulse if a == 1 else -lever * impulse
    elif a == d - 1 or a == d + 2:
        given[6 - a - d] += lever * impulse
    else:
        given[6 - a - d] -= lever * impulse


@inline()
def add(given, dim, place, k, d, impulse):
    """Add an impulse along axis d at ``place[k]``, and its moment."""
    given[d] += impulse
    for a in range(dim):
        if a != d:
            _turn(given, dim, a, place[k, a], d, impulse)


@function()
def hold(nodes, mirrors, acting, first, last, held):
    """Keep slots first..last-1 of ghosts before they are folded; slot 0 starts a new record."""
    for k in range(len(mirrors)):
        ghost = mirrors[k, 0]
        if first == 0:
            for q in range(FATE + 1):
                held[k, q] = 0.0
        anything = False
        for q in range(first, last):
            anything |= nodes[ghost, q] != 0.0
            held[k, q] += nodes[ghost, q]
        if anything:
            held[k, FATE] = FOLDED if _acts(nodes, mirrors[k, 2], acting) else LEFT


@inline()
def _value(nodes, i, dim, d, solved, of_change):
    """Δv, or v as mapped, of a node along an axis."""
    if of_change:
        return nodes[i, 1 + dim + d]
    return nodes[i, 1 + d] - nodes[i, 1 + dim + d] if solved else nodes[i, 1 + d]


@inline()
def _add_at_ghost(given, dim, axis, out, place, k, d, impulse):
    """Add an impulse at the ghost of a place on the face, or, with -out, at the image of that ghost."""
    add(given, dim, place, k, d, impulse)
    if d != axis:
        _turn(given, dim, axis, out, d, impulse)


@function()
def count_overwritten(nodes, mirrors, acting, sign, axis, out, place, solved, of_change, given):
    """Add the impulses on ghosts that have mass when they are filled, before the walls of the case act.

    A ghost has mass if the face did not act on it when others were folded, or if a wall has folded mass onto
    it. ``solved``: whether the momentum equation has been solved. The other arguments are those of ``count``.
    """
    dim = place.shape[1]
    for k in range(len(mirrors)):
        ghost, image, wall = mirrors[k, 0], mirrors[k, 1], mirrors[k, 2]
        m = nodes[ghost, 0]
        if m > 0.0 and _acts(nodes, wall, acting):
            for d in range(dim):
                before = _value(nodes, ghost, dim, d, solved, of_change)
                after = sign[1 + d] * _value(nodes, image, dim, d, solved, of_change)
                _add_at_ghost(given, dim, axis, out, place, k, d, m * (after - before))


@function()
def count(nodes, mirrors, acting, sign, axis, out, place, held, dt, given, mapped):
    """Add the impulses of the ghosts of a face when they are filled for the last time in a step of ``dt`` s.

    The impulses of the mapping are counted now too, because a face that begins to push in this step changes
    them. The velocity as mapped is v - Δv.

    Args:
        acting: bit of ``CONTACT`` of the nodes at which the face acts; 0 for all.
        sign: (NODE,) sign of every slot under reflection.
        axis, out: the axis of the face, and the distance of its ghosts from it along this axis, with sign, m.
        given, mapped: sums of the face, from the momentum equation and from the mapping.
    """
    dim = place.shape[1]
    for k in range(len(mirrors)):
        fate = held[k, FATE]
        if fate == 0.0:
            continue
        if fate == LEFT or not _acts(nodes, mirrors[k, 2], acting):
            _count_turned(nodes, mirrors, acting, sign, axis, out, place, held, k, 1.0, False, mapped)
            _count_turned(nodes, mirrors, acting, sign, axis, out, place, held, k, dt, True, given)
            continue
        m, image = held[k, 0], mirrors[k, 1]
        for d in range(dim):
            change = nodes[image, 1 + dim + d]
            moved, was_moved = m * change, m * (nodes[image, 1 + d] - change)
            force, momentum = dt * held[k, 1 + dim + d], held[k, 1 + d]
            if sign[1 + d] < 0.0:
                add(given, dim, place, k, d, -2.0 * (moved + force))
                add(mapped, dim, place, k, d, -2.0 * (was_moved + momentum))
            elif d != axis:  # no net impulse, but it has moved from the ghost to its image
                _turn(given, dim, axis, out, d, 2.0 * (moved - force))
                _turn(mapped, dim, axis, out, d, 2.0 * (was_moved - momentum))


@function()
def _count_turned(nodes, mirrors, acting, sign, axis, out, place, held, k, factor, of_change, given):
    """The same for a ghost whose face has stopped acting since it was folded, or begins to act now."""
    dim = place.shape[1]
    ghost, image, wall = mirrors[k, 0], mirrors[k, 1], mirrors[k, 2]
    folded, m, first = held[k, FATE] == FOLDED, held[k, 0], 1 + dim if of_change else 1
    if not (folded or _acts(nodes, wall, acting)):
        return
    for d in range(dim):
        s = sign[1 + d]
        at_image = m * _value(nodes, image, dim, d, True, of_change)
        at_ghost = m * _value(nodes, ghost, dim, d, True, of_change)
        due = factor * held[k, first + d]
        if folded:
            _add_at_ghost(given, dim, axis, out, place, k, d, at_ghost - due)
            _add_at_ghost(given, dim, axis, -out, place, k, d, s * due - at_image)
        else:
            _add_at_ghost(given, dim, axis, out, place, k, d, s * at_image - at_ghost)
