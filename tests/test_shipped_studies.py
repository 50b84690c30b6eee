"""Every study that is shipped is valid, and so is the case of each of its members."""

from pathlib import Path

import pytest

from mpmkit.study import load_study, members_of

STUDIES = sorted((Path(__file__).parents[1] / "cases" / "studies").glob("*.json"))


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_a_shipped_study_is_valid(path):
    study = load_study(path)
    assert study.description
    assert len(members_of(study)) > 1
