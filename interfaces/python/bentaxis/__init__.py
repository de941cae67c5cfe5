"""Reaction forces of bent-axis piston pumps by two independent models.

    import bentaxis
    case = bentaxis.read_case("bap63_rated")
    comparison = bentaxis.compare(case)
    print(comparison.headline)
    comparison.report("out")
"""

from . import _bentaxis
from ._bentaxis import *  # noqa: F401,F403
from ._bentaxis import __version__

__all__ = sorted(name for name in vars(_bentaxis) if not name.startswith("_"))


def _table(state):
    """A table from a pickle, which finds functions of Python's alone."""
    return _bentaxis._table(state)
