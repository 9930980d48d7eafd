"""What a campaign has left of each recording, as one flat row that a table or a page can be made of."""

import csv
import json
from dataclasses import dataclass, field
from pathlib import Path

import season

# In the order of eq. (4), as coefficients.toml names them; units: 3 in nT, 6 in nT/nT, 9 in s.
AXES = "xyz"
TERMS = (
    *(f"permanent {axis}" for axis in AXES),
    *(f"induced {a}{b}" for i, a in enumerate(AXES) for b in AXES[i:]),
    *(f"eddy {a} d{b}" for a in AXES for b in AXES),
)
UNITS = ("nT",) * 3 + ("nT/nT",) * 6 + ("s",) * 9
# Of a step that failed, so much of what it last said.
LAST_WORDS = 500


@dataclass
class Results:
    """Of one recording."""

    recording: season.Recording
    row: dict
    coefficients: list[tuple[float, float]] = field(default_factory=list)
    effects: list[dict] = field(default_factory=list)
    contacts: list[dict] = field(default_factory=list)
    programs: list[tuple[str, str]] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def read(folder: Path, table: str) -> list[Results]:
    """Of every recording of a campaign, in the order of its table; a campaign of trials alone has none."""
    return [] if not table else [_of(folder, recording) for recording in season.read(folder / table)]


def _of(folder: Path, recording: season.Recording) -> Results:
    row = {"name": recording.name, "body": recording.body, "day": recording.day, "kind": recording.kind}
    of = Results(recording, row | {"calibration": recording.calibration})
    seen: dict[str, str] = {}
    for step in season.STEPS[recording.kind]:
        outcome = _outcome(folder, recording.name, step)
        of.row[step] = outcome["outcome"]
        if outcome["outcome"] in ("refused", "failed"):
            of.problems.append(f"{step}: {outcome['message']}")
        if outcome["without"]:
            of.notes.append(f"{step} without a calibration: {outcome['without']}")
        if outcome["outcome"] == "done":
            READERS[step](folder, of)
            _trace(folder, of, step, seen)
    return of


def _outcome(folder: Path, name: str, step: str) -> dict:
    path = folder / "outcomes" / name / f"{step}.json"
    if path.is_file():
        return _json(path)
    log = folder / "logs" / name / f"{step}.log"
    if not log.is_file():
        return {"outcome": "missing", "message": None, "without": None}
    last = [line for line in log.read_text(errors="replace").splitlines() if not line.startswith("started: ")][-2:]
    return {"outcome": "failed", "message": " ".join(last)[-LAST_WORDS:] or "was cut", "without": None}


def _json(path: Path):
    return json.loads(path.read_text(encoding="utf-8"))


def _result(folder: Path, of: Results, step: str) -> dict:
    name = of.recording.name
    paths = {
        "import": f"recordings/{name}.import.json",
        "calibrate": f"results/{name}/calibration/summary.json",
        "survey": f"results/{name}/survey/summary.json",
        "diagnose": f"results/{name}/diagnosis/diagnosis.json",
    }
    return _json(folder / paths[step])


def _trace(folder: Path, of: Results, step: str, seen: dict[str, str]) -> None:
    """Which program made it, and whether all steps saw the same recording."""
    provenance = _result(folder, of, step).get("provenance")
    if provenance is None:
        of.notes.append(f"{step}: does not tell what it was made by")
        return
    of.programs.append((provenance["version"], provenance["commit"] or "unknown"))
    if step == "import":
        of.row["sources_sha256"] = " ".join(source["sha256"] for source in provenance["inputs"])
        return
    for source in provenance["inputs"]:
        role = source["role"]
        if role == "recording" and seen.setdefault(role, source["sha256"]) != source["sha256"]:
            of.problems.append(f"{step}: was made of another import than the step before it: run it again")


def _import(folder: Path, of: Results) -> None:
    report = _result(folder, of, "import")
    of.row |= {key: report[key] for key in ("format", "rows_in", "rows_out", "rows_invalid")}


def _calibrate(folder: Path, of: Results) -> None:
    summary = _result(folder, of, "calibrate")
    of.row |= {key: summary.get(key) for key in ("improvement_ratio", "condition_number", "noise_floor_nT")}
    of.row["duration_s"] = summary["used_rows"] / 10
    of.coefficients = list(zip(summary["coefficients"], summary["coefficient_std"]))


def _survey(folder: Path, of: Results) -> None:
    summary = _result(folder, of, "survey")
    of.row |= {key: summary[key] for key in ("duration_s", "contacts", "noise_floor_nT", "smallest_moment_Am2")}
    of.coefficients = list(zip(summary["coefficients"], summary["coefficient_std"]))
    with (folder / "results" / of.recording.name / "survey" / "contacts.csv").open(newline="", encoding="utf-8") as file:
        own = {"name": of.recording.name, "body": of.recording.body, "day": of.recording.day}
        of.contacts = [own | row for row in csv.DictReader(file)]


def _diagnose(folder: Path, of: Results) -> None:
    diagnosis = _result(folder, of, "diagnose")
    gap = diagnosis["gap"]
    of.effects = diagnosis["effects"]
    of.row |= {
        "verdict": diagnosis["verdict"],
        "effects": " ".join(effect["name"] for effect in of.effects),
        "residual_rms_nT": gap["residual_rms_nT"],
        "noise_rms_nT": gap["noise_floor_rms_nT"],
        "targets": len(diagnosis["targets"]),
        "unexplained": _unexplained(diagnosis.get("unexplained")),
        "summary": diagnosis.get("summary"),
    }


def _unexplained(found) -> str:
    """What no effect explains: the most probable driver, and the tests that saw it. Older programs wrote the tests alone."""
    found = found or []
    drivers, tests = (found.get("drivers") or [], found.get("tests") or []) if isinstance(found, dict) else ([], found)
    first = [f"{driver['input']} ({driver['probability']:.2f})" for driver in drivers[:1] if driver["input"] != "none"]
    return " ".join([*first, *(test["what"] for test in tests)])


READERS = {"import": _import, "calibrate": _calibrate, "survey": _survey, "diagnose": _diagnose}


def unknowns(folder: Path) -> list[dict]:
    """What several diagnoses of a campaign could not name."""
    path = folder / "unknowns" / "unknowns.json"
    return _json(path)["clusters"] if path.is_file() else []


def trials(folder: Path) -> list[dict]:
    """What the blind trials of a campaign scored, by seed."""
    found = []
    for path in folder.glob("trial/*/whole/trial.json"):
        trial = _json(path)
        score = trial["score"] or {}
        rates = {key: {"hits": rate["hits"], "of": rate["of"]} for key, rate in score.items() if _is_rate(rate)}
        options = trial["options"]
        found.append({"seed": options["seed"], "recordings": options["recordings"], "rates": rates})
    return sorted(found, key=lambda trial: trial["seed"])


def _is_rate(value) -> bool:
    return isinstance(value, dict) and {"hits", "of"} <= value.keys()
