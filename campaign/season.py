"""The recordings of a season, as `season.csv` names them."""

import csv
import re
import shlex
from dataclasses import dataclass, field, replace
from pathlib import Path

# The steps that a kind of recording goes through.
STEPS = {"calibration": ("import", "calibrate", "diagnose"), "tow": ("import", "survey", "diagnose")}
REQUIRED = ("name", "body", "day", "kind", "file")
OPTIONS = ("import", "survey", "diagnose")
# A name becomes a folder and a file, on any system.
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
DAY = re.compile(r"\d{4}-\d{2}-\d{2}")


class SeasonError(Exception):
    """What is wrong with the table, where, and what to do."""


@dataclass(frozen=True)
class Recording:
    """A row of the table."""

    name: str
    body: str
    day: str
    kind: str
    files: tuple[str, ...]
    calibration: str | None = None
    options: dict[str, tuple[str, ...]] = field(default_factory=dict)


def read(path: Path) -> list[Recording]:
    """The recordings in the order of the table, each tow with its calibration."""
    if not path.is_file():
        raise SeasonError(f"{path}: is not there: docs/campaign.md says what stands in it")
    with path.open(newline="", encoding="utf-8-sig") as file:
        table = csv.DictReader(file)
        missing = [column for column in REQUIRED if column not in (table.fieldnames or ())]
        if missing:
            raise SeasonError(f"{path}:1: lacks the column {', '.join(missing)}")
        recordings = [_recording(row, f"{path}:{table.line_num}") for row in table]
        asked = {row.name: row.calibration for row in recordings}
    if not recordings:
        raise SeasonError(f"{path}: names no recording")
    _check_names(recordings, path)
    calibrations = [row for row in recordings if row.kind == "calibration"]
    return [_calibrated(row, asked[row.name], calibrations, path) for row in recordings]


def _recording(row: dict, where: str) -> Recording:
    text = {column: (row.get(column) or "").strip() for column in (*REQUIRED, *OPTIONS, "calibration")}
    empty = [column for column in REQUIRED if not text[column]]
    if empty:
        raise SeasonError(f"{where}: {', '.join(empty)}: is empty")
    if not NAME.fullmatch(text["name"]):
        raise SeasonError(f"{where}: name {text['name']!r}: letters, digits, `.`, `_` and `-` only")
    if not DAY.fullmatch(text["day"]):
        raise SeasonError(f"{where}: day {text['day']!r}: must be as 2026-07-31")
    if text["kind"] not in STEPS:
        raise SeasonError(f"{where}: kind {text['kind']!r}: must be {' or '.join(STEPS)}")
    try:
        options = {step: tuple(shlex.split(text[step])) for step in OPTIONS}
    except ValueError as error:
        raise SeasonError(f"{where}: options: {error}") from None
    files = tuple(part.strip() for part in text["file"].split(";") if part.strip())
    given = text["calibration"] or None
    return Recording(text["name"], text["body"], text["day"], text["kind"], files, given, options)


def _check_names(recordings: list[Recording], path: Path) -> None:
    # Some file systems take `A` and `a` for one.
    seen: set[str] = set()
    for row in recordings:
        if row.name.casefold() in seen:
            raise SeasonError(f"{path}: name {row.name}: is there twice")
        seen.add(row.name.casefold())


def _calibrated(row: Recording, asked: str | None, calibrations: list[Recording], path: Path) -> Recording:
    """With what its body was calibrated on: the one that is asked for, else the latest of that day or before it."""
    if row.kind == "calibration":
        return row
    if asked is not None:
        if asked not in [calibration.name for calibration in calibrations]:
            raise SeasonError(f"{path}: {row.name}: calibration {asked}: no recording of that kind has this name")
        return row
    before = [calibration for calibration in calibrations if calibration.body == row.body and calibration.day <= row.day]
    latest = max(before, key=lambda calibration: calibration.day, default=None)
    return replace(row, calibration=latest.name if latest else None)
