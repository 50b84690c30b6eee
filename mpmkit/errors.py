"""Every way a run can end badly, each with the exit status that it gives the command line."""

from __future__ import annotations

import textwrap

LONGEST_REASON = 300
"""Characters that are repeated of an error that is not our own."""


class MpmkitError(Exception):
    """An error that is shown as one sentence, without a traceback."""

    exit_status = 1


class CaseError(MpmkitError):
    """Bad input: the sentence names the field, the value and what is allowed."""

    exit_status = 2


class GuardStop(MpmkitError):
    """A run that a guard stopped; what was written so far is kept.

    Attributes:
        guard: short name of the guard, for ``summary.json``.
        step: number of the step in which it stopped.
        particle: number of the particle concerned, or None.
    """

    exit_status = 3

    def __init__(self, guard: str, message: str, *, step: int, particle: int | None = None) -> None:
        super().__init__(message)
        self.guard = guard
        self.step = step
        self.particle = particle

    def __reduce__(self) -> tuple:
        """So that it can travel from a process to another one: a pool waits for ever for one that cannot."""
        return _guard_stop, (self.guard, str(self), self.step, self.particle)


def _guard_stop(guard: str, message: str, step: int, particle: int | None) -> GuardStop:
    return GuardStop(guard, message, step=step, particle=particle)


class PluginStop(GuardStop):
    """A plug-in raised an exception, gave back what cannot be used, or wrote where it must not.

    It is never a sign that the case or its time step is wrong.
    """

    def __init__(self, message: str, *, step: int = 0, particle: int | None = None) -> None:
        super().__init__("plug-in-error", message, step=step, particle=particle)


class PluginFault(Exception):
    """A plug-in gave back what cannot be used, or wrote where it must not; ``blame`` names it.

    Attributes:
        plugin: the plug-in at fault; None for the one that called the framework.
        particle: number of the particle concerned, or None.
    """

    def __init__(self, plugin: object | None, what: str, *, particle: int | None = None) -> None:
        super().__init__(what)
        self.plugin = plugin
        self.particle = particle


class OutputError(MpmkitError):
    """Results could not be written: disk full, no permission, directory taken."""

    exit_status = 4


class Undrawn(KeyboardInterrupt):
    """Ctrl-C while the pictures were drawn of a run that had ended; says how to draw them."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C in the middle of a run; says where the results up to then are."""


def reason(error: BaseException) -> str:
    """What an error says, in one line; for one that was not written to be read, its name as well."""
    if isinstance(error, MpmkitError):
        return " ".join(str(error).split())
    try:
        text = textwrap.shorten(str(error), LONGEST_REASON, placeholder=" …")
    except Exception:  # an exception of a plug-in's own may not even be able to say what it is
        text = ""
    return f"{type(error).__name__}: {text}" if text else type(error).__name__
