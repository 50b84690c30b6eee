"""Images of the material behind the faces of a domain: mirror images, and the next period."""

from __future__ import annotations

import numpy as np

from .domain import Domain
from .section import Section


def beyond_faces(section: Section, domain: Domain, reach: float) -> Section:
    """The section with images of the material within ``reach``, m, of a face.

    Gaps can open between a particle and a face as between two particles. With the images, both are closed in
    the same way. The images lie behind the face, where the picture ends.
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
            # Images come first: additions shift the indices of the material.
            added = len(section) - len(of)
            section = section.with_image(np.append(np.zeros(added, dtype=bool), of), factor, shift)
    return section
