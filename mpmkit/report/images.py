"""What the faces of a domain make of the material in front of them: mirror images, and the next period."""

from __future__ import annotations

import numpy as np

from .domain import Domain
from .section import Section


def beyond_faces(section: Section, domain: Domain, reach: float) -> Section:
    """The section with images of what lies within ``reach``, m, of a face.

    A box over a face of its own domain leaves a gap there, as it does between two particles that part;
    with the images, the one is closed as the other is. They lie behind the face: a picture ends there.
    """
    for axis, period in enumerate(domain.period):
        ends = (float(domain.lower[axis]), float(domain.upper[axis]))
        along = section.centre[:, axis]
        near = [np.abs(along - end) <= reach for end in ends]
        images = []
        for side, end in enumerate(ends):
            if period is not None:
                images.append((near[side], np.ones(2), np.eye(2)[axis] * (period, -period)[side]))
            elif domain.wall[axis][side]:
                images.append((near[side], 1 - 2 * np.eye(2)[axis], np.eye(2)[axis] * 2 * end))
        for of, factor, shift in images:
            # Images come first: what is added shifts the material's own places.
            added = len(section) - len(of)
            section = section.with_image(np.append(np.zeros(added, dtype=bool), of), factor, shift)
    return section
