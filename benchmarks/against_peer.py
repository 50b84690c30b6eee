"""The standard scenes against another program, in turn: medians of their speeds, and the ratios."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from statistics import median

OURS = ("seed-3d", "accurate-3d")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("peer", help="the other program, see README.md")
    parser.add_argument("--python", default=sys.executable, help="interpreter that runs it")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=5)
    return parser.parse_args()


def output_of(*command: str) -> object:
    """What a program prints as JSON; a line before it, such as a library's greeting, is passed over."""
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    lines = printed.splitlines(keepends=True)
    start = next(number for number, line in enumerate(lines) if line.rstrip() in ("[", "{") or line[0] == "{")
    return json.loads("".join(lines[start:]))


def ours(scene: str, threads: int) -> float:
    """Millions of particle-steps a second of a standard scene."""
    command = [sys.executable, "-m", "mpmkit", "bench", scene, "--threads", str(threads), "--json"]
    (timing,) = output_of(*command, "--seconds", "3")
    return timing["particle_steps_per_second"] / 1e6


def theirs(chosen: argparse.Namespace) -> float:
    options = {"--size": "350k", "--threads": chosen.threads, "--precision": 64, "--repetitions": 1}
    flat = [str(word) for option in options.items() for word in option]
    return median(output_of(chosen.python, chosen.peer, *flat)["wall"])


def main() -> None:
    chosen = arguments()
    speeds: dict[str, list[float]] = {"peer": [], **{scene: [] for scene in OURS}}
    for _ in range(chosen.rounds):
        speeds["peer"].append(theirs(chosen))
        for scene in OURS:
            speeds[scene].append(ours(scene, chosen.threads))
    of_peer = median(speeds["peer"])
    print(f"Threads: {chosen.threads}, rounds: {chosen.rounds}, in turn.\n")
    print("| | million particle-steps/s: median | least | most | over the peer |")
    print("|---|---|---|---|---|")
    for name, found in speeds.items():
        print(
            f"| {name} | {median(found):.2f} | {min(found):.2f} | {max(found):.2f} "
            f"| {median(found) / of_peer:.2f} |"
        )


if __name__ == "__main__":
    main()
