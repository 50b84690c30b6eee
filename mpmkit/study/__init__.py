"""Studies: variations of a case, run in parallel, with all results in one dataset."""

from .collect import collect
from .execute import execute
from .load import load_study, parse_study
from .members import Member, members_of
from .model import Study

__all__ = ["Member", "Study", "collect", "execute", "load_study", "members_of", "parse_study"]
