"""What several diagnoses of a season call unknown, held against each other.

Recordings whose rest is driven by the same input make a cluster. Of the effects that were proposed for them, the three that close most
are tried on all others, as `diagnose --effect-file`; the one that is named on most recordings stands for the cluster, and is written as
one effect file: "seen on 7 of 30 tows, with current_pump_A". Made of what the diagnoses have left: the same season gives the same bytes.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import season
import whole

# A driver that is less likely than not makes no cluster.
LIKELY = 0.5
# Proposals that are tried on all recordings of a cluster: each costs a diagnosis of every one.
MOST_TRIED = 3
# Inputs that nobody has recorded: a course in time is another one on every tow.
NOT_RECORDED = ("none", "time_periodic", "time_irregular")
# host-sim: what it was given is at fault.
BAD_INPUT = 2


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--season", default="season.csv", help="name of the table")
    parser.add_argument("--host-sim", default="host-sim")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--options", type=json.loads, default=[], help="of `diagnose`, as a list in JSON")
    parser.add_argument("--out", type=Path, required=True)
    told = parser.parse_args()
    found = rests(Path("."), told.season)
    tried = Trials(told)
    clusters = [cluster(name, members, found, tried) for name, members in by_driver(found).items()]
    clusters.sort(key=lambda one: (-len(one["seen_on"]), -len(one["members"]), one["driver"]))
    told.out.mkdir(parents=True, exist_ok=True)
    for one in clusters:
        if one["effect_file"]:
            source = tried.file(one["proposed_on"])
            text = f"# {one['text']}\n{source.read_text(encoding='utf-8')}"
            whole.replace(told.out / one["effect_file"], text)
    shutil.rmtree(told.out / "tried", ignore_errors=True)
    whole.replace(told.out / "unknowns.json", json.dumps({"schema": 1, "clusters": clusters}, indent=2) + "\n")
    return 0


def rests(folder: Path, table: str) -> dict[str, dict]:
    """What each diagnosis of a season could not name, by recording; the others are there with nothing."""
    found = {}
    for recording in season.read(folder / table) if table else []:
        path = folder / "results" / recording.name / "diagnosis" / "diagnosis.json"
        if path.is_file():
            rest = json.loads(path.read_text(encoding="utf-8")).get("unexplained")
            found[recording.name] = rest if isinstance(rest, dict) else {}
    return found


def by_driver(found: dict[str, dict]) -> dict[str, list[str]]:
    """Recordings by the input that drives what is left of them, where that is likely and recorded; two at least."""
    clusters: dict[str, list[str]] = {}
    for name, rest in found.items():
        first = (rest.get("drivers") or [{"input": "none", "probability": 0.0}])[0]
        if first["probability"] >= LIKELY and first["input"] not in NOT_RECORDED:
            clusters.setdefault(first["input"], []).append(name)
    return {driver: members for driver, members in sorted(clusters.items()) if len(members) > 1}


def cluster(driver: str, members: list[str], found: dict[str, dict], tried: "Trials") -> dict:
    """A cluster with the proposal that is named on most of its recordings."""
    proposals = [name for name in members if found[name].get("effect_file") and tried.file(name).is_file()]
    proposals.sort(key=lambda name: (-found[name]["gap_closed"]["ci95"][0], name))
    pairs = [(name, other) for name in proposals[:MOST_TRIED] for other in members if other != name]
    named = tried.all(pairs)
    seen_by = {name: sorted([name, *(other for on, other in named if on == name)]) for name in proposals[:MOST_TRIED]}
    best = max(seen_by, key=lambda name: len(seen_by[name]), default=None)
    if best and len(seen_by[best]) == 1:
        best = None  # an effect that nobody else has seen is that recording's own
    seen = seen_by[best] if best else []
    none = "no effect that was proposed on one is named on another" if proposals else "no effect was proposed"
    text = f"seen on {len(seen)} of {len(found)} recordings, with {driver}" if best else f"on {len(members)} of {len(found)} recordings, with {driver}; {none}"
    return {
        "driver": driver,
        "members": members,
        "proposed_on": best,
        "seen_on": seen,
        "effect_file": f"{driver}.toml" if best else None,
        "text": text,
    }


class Trials:
    """Runs proposals of recordings on others."""

    def __init__(self, told: argparse.Namespace):
        self.told = told

    @staticmethod
    def file(name: str) -> Path:
        return Path("results") / name / "diagnosis" / "proposed_effect.toml"

    def all(self, pairs: list[tuple[str, str]]) -> list[tuple[str, str]]:
        """Those of the pairs where what was proposed on the first is named on the second; so many at a time as there are threads."""
        with ThreadPoolExecutor(self.told.threads) as pool:
            return [pair for pair, is_named in zip(pairs, pool.map(lambda pair: self.names(*pair), pairs)) if is_named]

    def names(self, proposed_on: str, other: str) -> bool:
        """Whether the effect that was proposed on one recording is named on another."""
        out = self.told.out / "tried" / proposed_on / other
        out.parent.mkdir(parents=True, exist_ok=True)
        command = [self.told.host_sim, "diagnose", "--quiet", f"recordings/{other}.csv", "--out", str(out)]
        command += ["--effect-file", str(self.file(proposed_on)), *self.told.options]
        environment = os.environ | {"RAYON_NUM_THREADS": "1"}
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, env=environment, check=False)
        if done.returncode == BAD_INPUT:
            # A proposal of another version of host-sim, or a recording that has not its columns: no reason to end a campaign.
            print(f"{proposed_on} on {other}: {done.stderr.decode(errors='replace').strip()}", file=sys.stderr)
            return False
        if done.returncode:
            raise SystemExit(f"{' '.join(command)}: {done.stderr.decode(errors='replace').strip()}")
        diagnosis = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
        return any(effect["name"].startswith("proposed_") for effect in diagnosis["effects"])


if __name__ == "__main__":
    sys.exit(main())
