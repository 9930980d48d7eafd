"""Makes the files of this folder again: `python make.py`; a MagNav flight: `python make.py flight REC.csv OUT.h5`.

One tow, written by other people's writers in the formats and dialects that instruments and programs have. What the
importer must give back is in truth*.csv, and for each file in manifest.toml, which this script writes too.
"""

import csv
import gzip
import io
import re
import struct
import sys
import zipfile
from datetime import datetime, timedelta, timezone
from pathlib import Path

import h5py
import numpy as np
import openpyxl
import pandas as pd
import scipy.io
import xlwt

HERE = Path(__file__).parent
# 10 s before midnight, so that dates change within the tow.
START = datetime(2024, 5, 17, 23, 59, 50, tzinfo=timezone.utc)
START_OF_DAY_S = 86390.0
ROWS = 400
SHORT = 150

# ---------------------------------------------------------------------------------------------------------- the tow


def attitude(t):
    """Roll, pitch, heading in degrees: once round in 40 s, with some rolling and pitching."""
    roll = 8.0 * np.sin(2 * np.pi * t / 6.3)
    pitch = 5.0 * np.sin(2 * np.pi * t / 4.7 + 0.4)
    return roll, pitch, np.mod(350.0 + 9.0 * t, 360.0)


def field_in_body(t):
    """50,000 nT, inclination 66, declination 8.5 degrees, in body axes: x forward, y starboard, z down."""
    inclination, declination = np.radians(66.0), np.radians(8.5)
    north = np.cos(inclination) * np.cos(declination)
    east = np.cos(inclination) * np.sin(declination)
    earth = 50000.0 * np.array([north, east, np.sin(inclination)])
    roll, pitch, heading = (np.radians(angle) for angle in attitude(t))
    cr, sr, cp, sp, ch, sh = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(heading), np.sin(heading)
    x = cp * ch * earth[0] + cp * sh * earth[1] - sp * earth[2]
    y = (sr * sp * ch - cr * sh) * earth[0] + (sr * sp * sh + cr * ch) * earth[1] + sr * cp * earth[2]
    z = (cr * sp * ch + sr * sh) * earth[0] + (cr * sp * sh - sr * ch) * earth[1] + cr * cp * earth[2]
    return np.array([x, y, z])


def scalar(t):
    """What the body's own iron leaves of the field: a permanent and an induced part."""
    field = field_in_body(t)
    total = np.linalg.norm(field, axis=0)
    c = field / total
    return total + 21.0 * c[0] - 13.0 * c[1] + 17.0 * c[2] + 9.0 * c[0] ** 2 - 6.0 * c[0] * c[1] + 4.0 * c[1] * c[2]


def tow(t, noise):
    """All columns of the recording format at these times. `noise` is a frozen stream, or None."""
    random = noise.normal if noise else (lambda _mean, _sigma, size: np.zeros(size))
    flux = field_in_body(t) + random(0.0, 0.3, (3, len(t)))
    roll, pitch, heading = attitude(t)
    north_m, east_m = 2.0 * 40.0 / (2 * np.pi) * np.array([np.sin(2 * np.pi * t / 40), 1 - np.cos(2 * np.pi * t / 40)])
    columns = {
        "time_s": t,
        "scalar_nT": scalar(t) + random(0.0, 0.02, len(t)),
        "flux_x_nT": flux[0],
        "flux_y_nT": flux[1],
        "flux_z_nT": flux[2],
        "depth_m": 12.0 + 0.8 * np.sin(2 * np.pi * t / 7.1),
        "altitude_m": 6.5 - 0.8 * np.sin(2 * np.pi * t / 7.1),
        "temperature_degC": 9.0 + 0.01 * t,
        "roll_deg": roll,
        "pitch_deg": pitch,
        "heading_deg": heading,
        "latitude_deg": 49.1 + north_m / 111200.0,
        "longitude_deg": 32.9 + east_m / (111300.0 * np.cos(np.radians(49.1))),
        "current_strobe_A": np.where(np.mod(t, 1.5) < 0.25, 2.1, 0.3),
        "utc_s": START.timestamp() + t,
    }
    digits = {"time_s": 4, "latitude_deg": 8, "longitude_deg": 8, "utc_s": 4}
    table = pd.DataFrame({name: np.round(values, digits.get(name, 3)) for name, values in columns.items()})
    table["line"] = np.where(t < 20.0, 101, 102)
    return table


# RandomState is the stream that numpy promises never to change.
TRUTH = tow(np.arange(ROWS) / 10.0, np.random.RandomState(20240517))

# ---------------------------------------------------------------------------------------------------- the manifest

MANIFEST = []
# What a column is worth when written with so many digits: half of the last one, and a little.
OURS = {
    "scalar_nT": 0.00051,
    "flux_x_nT": 0.0051,
    "flux_y_nT": 0.0051,
    "flux_z_nT": 0.0051,
}


def toml_value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    return '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"'


def imported(file, dialect, columns=None, **more):
    """Says what must come back: columns with tolerances, and in `more` what else the README explains."""
    MANIFEST.append({"file": file, "dialect": dialect, "expect": "imported", "columns": columns or OURS, **more})


def refused(file, dialect, says, **more):
    """Says that it cannot be imported, and which words the message must have."""
    MANIFEST.append({"file": file, "dialect": dialect, "expect": "refused", "says": says, **more})


def write_manifest():
    text = "# Written by make.py; README.md says what the keys mean.\n"
    for entry in sorted(MANIFEST, key=lambda entry: entry["file"]):
        text += "\n[[file]]\n" + "".join(f"{key} = {toml_value(value)}\n" for key, value in entry.items())
    (HERE / "manifest.toml").write_text(text, encoding="utf-8")


# ------------------------------------------------------------------------------------------------------------- text


def save(file, text, encoding="utf-8", newline="\n"):
    data = text.replace("\n", newline).encode(encoding)
    if file.endswith(".gz"):
        data = gzip.compress(data, mtime=0)
    (HERE / file).write_bytes(data)


def stamp(row, form):
    """The time of a row in `form` of strftime, %f cut to tenths."""
    moment = START + timedelta(milliseconds=round(float(row.time_s) * 1000))
    return moment.strftime(form).replace("%1", str(moment.microsecond // 100000))


def number(digits, column, factor=1.0):
    """A way to write a column with so many digits."""
    return lambda row: f"{getattr(row, column) * factor:.{digits}f}"


def seconds(row):
    return f"{START_OF_DAY_S + row.time_s:.1f}"


FIELD = [
    ("scalar", number(3, "scalar_nT")),
    ("flux_x", number(2, "flux_x_nT")),
    ("flux_y", number(2, "flux_y_nT")),
    ("flux_z", number(2, "flux_z_nT")),
]


def rows_of(columns, rows=SHORT, table=None):
    table = TRUTH if table is None else table
    return [[write(row) for _, write in columns] for row in table.head(rows).itertuples()]


def delimited(columns, delimiter=",", rows=SHORT, header=True, change=None, table=None):
    """The text of a table; `change(lines)` may spoil the lists of fields first."""
    lines = rows_of(columns, rows, table)
    if change:
        change(lines)
    names = [[name for name, _ in columns]] if header else []
    return "".join(delimiter.join(fields) + "\n" for fields in names + lines)


def plain(time_name="time", write=seconds):
    return [(time_name, write), *FIELD]


def text_dialects():
    offset = {"rows": SHORT, "time_offset_s": START_OF_DAY_S}
    every = [("time_s", number(1, "time_s")), *[(f"{n}_nT", w) for n, w in FIELD]]
    every += [(n, number(2, n)) for n in ("depth_m", "roll_deg", "pitch_deg", "heading_deg")]
    every += [(n, number(7, n)) for n in ("latitude_deg", "longitude_deg")]
    save("own.csv", delimited(every))
    whole = {**OURS, **{n: 0.0051 for n in ("depth_m", "roll_deg", "pitch_deg", "heading_deg")}}
    whole |= {n: 0.6e-7 for n in ("latitude_deg", "longitude_deg")}
    imported("own.csv", "this project's own names", whole, rows=SHORT, time_offset_s=0.0)

    save("crlf_quoted.csv", delimited([(f'"{n}"', w) for n, w in every]), newline="\r\n")
    imported("crlf_quoted.csv", "quoted names, CR LF", whole, rows=SHORT, time_offset_s=0.0)

    save("semicolon_decimal_comma.csv", delimited(plain(), ";").replace(".", ","))
    imported("semicolon_decimal_comma.csv", "semicolons, decimal commas", findings=["delimiter"], **offset)
    save("tab.tsv", delimited(plain(), "\t"))
    imported("tab.tsv", "tabs", **offset)
    aligned = [[n for n, _ in plain()], *rows_of(plain())]
    save("aligned.txt", "".join(" ".join(f"{v:>12}" for v in line) + "\n" for line in aligned))
    imported("aligned.txt", "aligned by blanks", **offset)
    save("pipe.txt", delimited(plain(), "|"))
    imported("pipe.txt", "bars", **offset)
    save("no_header.csv", delimited(plain(), header=False))
    imported("no_header.csv", "no header", findings=["choice"], **offset)
    comment = "# towed body 3, lake\n# flight of 2024-05-17\n#\n"
    save("comments.csv", comment + delimited(plain()).replace("\n", "\n# a mark by the operator\n", 50))
    imported("comments.csv", "comments with #, also among the rows", **offset)
    preamble = "Instrument: towed body 3\nOperator: J. Doe\nDate: 17 May 2024\n\n"
    save("preamble.csv", preamble + delimited(plain()))
    imported("preamble.csv", "free text before the header", **offset)
    units = "s,nT,nT,nT,nT\n"
    save("units_row.csv", delimited(plain()).replace("\n", "\n" + units, 1))
    imported("units_row.csv", "a row of units below the header", **offset)
    bracketed = [("Time [s]", seconds), *[(f"{n.title()} (nT)", w) for n, w in FIELD]]
    save("utf16_bom.csv", delimited(bracketed), "utf-16")
    imported("utf16_bom.csv", "UTF-16 with byte order mark, units in brackets", **offset)
    save("utf8_bom.csv", delimited(bracketed), "utf-8-sig")
    imported("utf8_bom.csv", "UTF-8 with byte order mark, units in brackets", **offset)
    angles = [(f"{n.title()} (\u00b0)", number(2, f"{n}_deg")) for n in ("roll", "pitch", "heading")]
    temperature = [("Temperature (\u00b0C)", number(2, "temperature_degC"))]
    save("latin1_degrees.csv", delimited(bracketed + angles + temperature, ";"), "latin-1")
    angle = {n: 0.0051 for n in ("roll_deg", "pitch_deg", "heading_deg", "temperature_degC")}
    imported("latin1_degrees.csv", "Latin-1 with degree signs", {**OURS, **angle}, **offset)
    save("packed.csv.gz", delimited(plain(), rows=ROWS))
    imported("packed.csv.gz", "gzip", rows=ROWS, time_offset_s=START_OF_DAY_S)
    scrambled = [FIELD[3], ("aux", lambda row: "1"), FIELD[1], ("time", seconds), FIELD[0], FIELD[2]]
    save("scrambled.csv", delimited(scrambled))
    imported("scrambled.csv", "columns in another order, one of no meaning", **offset)
    bare = [("Timestamp", seconds), ("TMI", FIELD[0][1]), ("Bx", FIELD[1][1]), ("By", FIELD[2][1]), ("Bz", FIELD[3][1])]
    save("other_names.csv", delimited(bare))
    imported("other_names.csv", "TMI, Bx, By, Bz", **offset)


def time_dialects():
    utc = {"rows": SHORT, "time_offset_s": START.timestamp()}
    save("iso_z.csv", delimited(plain("timestamp", lambda row: stamp(row, "%Y-%m-%dT%H:%M:%S.%%1Z"))))
    imported("iso_z.csv", "ISO 8601 with Z", {**OURS, "utc_s": 0.001}, **utc)
    kyiv = lambda row: stamp(row._replace(time_s=row.time_s + 3 * 3600), "%Y-%m-%d %H:%M:%S.%%1+03:00")
    save("iso_offset.csv", delimited(plain("timestamp", kyiv)))
    imported("iso_offset.csv", "ISO 8601 with an offset from UTC", {**OURS, "utc_s": 0.001}, **utc)
    clock = ("Time", lambda row: stamp(row, "%H:%M:%S.%%1"))
    save("date_and_time.csv", delimited([("Date", lambda row: stamp(row, "%Y-%m-%d")), clock, *FIELD]))
    imported("date_and_time.csv", "date and time of day apart, through midnight", **utc)
    save("time_of_day.csv", delimited([clock, *FIELD]))
    day = {"rows": SHORT, "time_offset_s": START_OF_DAY_S}
    imported("time_of_day.csv", "time of day alone, through midnight", **day)
    save("day_month_year.csv", delimited([("Datum", lambda row: stamp(row, "%d.%m.%Y")), clock, *FIELD], ";"))
    imported("day_month_year.csv", "17.05.2024", **utc)
    milliseconds = lambda row: str(round((START.timestamp() + row.time_s) * 1000))
    save("unix_milliseconds.csv", delimited(plain("unix_ms", milliseconds)))
    imported("unix_milliseconds.csv", "milliseconds since 1970", **utc)
    jittered = np.random.RandomState(7).uniform(-0.008, 0.008, ROWS)
    save("jittered.csv", delimited(plain("time", lambda row: f"{row.time_s + jittered[row.Index]:.3f}")))
    slack = {"scalar_nT": 3.0, "flux_x_nT": 250.0, "flux_y_nT": 250.0, "flux_z_nT": 250.0}
    imported("jittered.csv", "stamps off by up to 8 ms of a regular sampler", slack, rows=SHORT, time_offset_s=0.0)
    save("whole_seconds.csv", delimited(plain("time", lambda row: f"{START_OF_DAY_S + int(row.time_s):.0f}")))
    imported("whole_seconds.csv", "stamps of whole seconds, ten rows each", time_slack_s=1.0, **day)


def unit_dialects():
    offset = {"rows": SHORT, "time_offset_s": START_OF_DAY_S}
    micro = [("time", seconds), FIELD[0], *[(f"b{a} (uT)", number(5, f"flux_{a}_nT", 1e-3)) for a in "xyz"]]
    save("microtesla.csv", delimited(micro))
    imported("microtesla.csv", "fluxgate in microtesla, said", **offset)
    unsaid = [("time", seconds), FIELD[0], *[(f"flux_{a}", number(5, f"flux_{a}_nT", 1e-3)) for a in "xyz"]]
    save("microtesla_unsaid.csv", delimited(unsaid))
    imported("microtesla_unsaid.csv", "fluxgate in microtesla, not said", findings=["units"], **offset)
    gauss = [("time", seconds), FIELD[0], *[(f"b{a}[gauss]", number(7, f"flux_{a}_nT", 1e-5)) for a in "xyz"]]
    save("gauss.csv", delimited(gauss))
    imported("gauss.csv", "fluxgate in gauss, said", **offset)
    for name, dummy in (("99999", "-99999"), ("star", "*"), ("1e32", "-1e32"), ("nan", "NaN"), ("empty", "")):

        def spoil(lines):
            for row in (10, 11, 57, 120):
                lines[row][1] = dummy
            lines[90][3] = dummy

        save(f"dummy_{name}.csv", delimited(plain(), change=spoil))
        missing = {"scalar_nT": [10, 11, 57, 120], "flux_y_nT": [90]}
        found = {"findings": ["dummies"]} if dummy not in ("", "NaN") else {}
        imported(f"dummy_{name}.csv", f'missing is "{dummy}"', missing=missing, **found, **offset)


def faulty_text():
    offset = {"rows": SHORT, "time_offset_s": START_OF_DAY_S}
    text = delimited(plain())
    save("truncated_line.csv", text[: text.rindex(",") - 3])
    imported("truncated_line.csv", "the last line is cut", findings=["truncated"], invalid=[SHORT - 1], **offset)

    def backward(lines):
        lines[80][0] = lines[70][0]

    def repeated(lines):
        lines[80][0] = lines[79][0]

    save("backward_stamp.csv", delimited(plain(), change=backward))
    imported("backward_stamp.csv", "one stamp runs back", findings=["order"], invalid=[80], **offset)
    save("repeated_stamp.csv", delimited(plain(), change=repeated))
    imported("repeated_stamp.csv", "one stamp repeated", findings=["order"], invalid=[80], **offset)
    save("scalar_only.csv", delimited([("time", seconds), FIELD[0]]))
    only = {"scalar_nT": OURS["scalar_nT"]}
    absent = ["flux_x_nT", "flux_y_nT", "flux_z_nT"]
    imported("scalar_only.csv", "no fluxgate", only, absent=absent, findings=["missing"], **offset)
    save("vectors_only.csv", delimited([("time", seconds), *FIELD[1:]]))
    vectors = {n: OURS[n] for n in absent}
    imported("vectors_only.csv", "no scalar", vectors, absent=["scalar_nT"], findings=["missing"], **offset)
    save("no_time.csv", delimited(FIELD))
    imported("no_time.csv", "no time, rate by option", options=["--rate", "10"], rows=SHORT, time_offset_s=0.0)
    save("no_time_no_rate.csv", delimited(FIELD))
    refused("no_time_no_rate.csv", "no time, no rate", ["--rate"])
    save("header_alone.csv", "time,scalar,flux_x,flux_y,flux_z\n")
    refused("header_alone.csv", "no rows", ["row"])
    save("nothing.csv", "")
    refused("nothing.csv", "an empty file", ["empty"])
    save("prose.txt", "Dear colleague,\n\nthe recording is on the other disk.\n\nYours\n")
    refused("prose.txt", "no table", [])


def swapped_axes():
    offset = {"rows": SHORT, "time_offset_s": START_OF_DAY_S}
    up = [("time", seconds), FIELD[0], ("flux_x", number(2, "flux_x_nT")), ("flux_y", number(2, "flux_y_nT", -1.0))]
    up += [("flux_z", number(2, "flux_z_nT", -1.0))]
    up += [(f"{n}_deg", number(2, f"{n}_deg")) for n in ("roll", "pitch", "heading")]
    save("axes_up.csv", delimited(up, rows=280))
    imported("axes_up.csv", "x forward, y port, z up", **(offset | {"rows": 280, "options": ["--axes", "x,-y,-z"]}))
    names = {"scalar": "scalar", "flux_x": "flux_z", "flux_y": "flux_y", "flux_z": "flux_x"}
    left = [("time", seconds), *[(names[n], w) for n, w in FIELD]]
    left += [(f"{n}_deg", number(2, f"{n}_deg")) for n in ("roll", "pitch", "heading")]
    save("axes_left_handed.csv", delimited(left, rows=ROWS))
    only = {"scalar_nT": OURS["scalar_nT"]}
    imported("axes_left_handed.csv", "x and z exchanged", only, findings=["handedness"], **(offset | {"rows": ROWS}))


def faster_samplers():
    for rate, seconds_long in ((20, 40), (100, 20), (160, 12)):
        clean = tow(np.arange(seconds_long * 10) / 10.0, None)[["time_s", *OURS]]
        clean.to_csv(HERE / f"truth_{rate}hz.csv.gz", index=False, compression={"method": "gzip", "mtime": 0})
        fast = tow(np.arange(seconds_long * rate) / rate, None)
        fast["scalar_nT"] += 2.0 * np.sin(2 * np.pi * 0.45 * rate * fast["time_s"] + 0.3)
        columns = [("time", number(5, "time_s")), ("scalar", number(2, "scalar_nT"))]
        columns += [(f"flux_{a}", number(1, f"flux_{a}_nT")) for a in "xyz"]
        file = f"rate_{rate}hz.csv.gz"
        save(file, delimited(columns, rows=len(fast), table=fast))
        tolerance = {"scalar_nT": 0.05, "flux_x_nT": 3.0, "flux_y_nT": 3.0, "flux_z_nT": 3.0}
        more = {"truth": f"truth_{rate}hz.csv.gz", "rows": len(fast), "source_rate_hz": float(rate), "edge_s": 1.0}
        imported(file, f"{rate} Hz with a tone of {0.45 * rate:g} Hz", tolerance, time_offset_s=0.0, **more)
    slow = TRUTH.iloc[::10]
    save("rate_1hz.csv", delimited(plain(), table=slow))
    more = {"every": 10, "rows": len(slow), "source_rate_hz": 1.0, "findings": ["rate"]}
    imported("rate_1hz.csv", "1 Hz", time_offset_s=START_OF_DAY_S, **more)


# --------------------------------------------------------------------------------------------- formats that are text


def geosoft_xyz():
    head = "/ Geosoft XYZ export\n/ time x_flux y_flux z_flux mag depth\n//Flight 7\n//Date 2024/05/17\n"
    lines, last = [], None
    for row in TRUTH.itertuples():
        if row.line != last:
            lines.append(f"Line {row.line}")
            last = row.line
        mag = "*" if row.Index in (30, 31, 250) else f"{row.scalar_nT:.3f}"
        flux = f"{row.flux_x_nT:.2f} {row.flux_y_nT:.2f} {row.flux_z_nT:.2f}"
        lines.append(f"{seconds(row)} {flux} {mag} {row.depth_m:.2f}")
    save("geosoft.xyz", head + "\n".join(lines) + "\n")
    more = {"missing": {"scalar_nT": [30, 31, 250]}, "findings": ["dummies"]}
    columns = {**OURS, "depth_m": 0.0051}
    imported("geosoft.xyz", "Geosoft XYZ: lines, comments, *", columns, rows=ROWS, time_offset_s=START_OF_DAY_S, **more)


def aseg_gdf2():
    definitions = [
        ("Line", "I8", "NULL=-9999999", "NAME=Line number", lambda r: f"{r.line:8d}"),
        ("Date", "I9", "NULL=-9999999", "NAME=Date (yyyymmdd)", lambda r: f"{stamp(r, '%Y%m%d'):>9}"),
        ("Time_UTC", "F10.1", "UNIT=s:NULL=-999999.9", "NAME=UTC seconds since midnight", None),
        ("Latitude", "F13.7", "UNIT=deg:NULL=-99.9999999", "NAME=Latitude", lambda r: f"{r.latitude_deg:13.7f}"),
        ("Longitude", "F13.7", "UNIT=deg:NULL=-999.9999999", "NAME=Longitude", lambda r: f"{r.longitude_deg:13.7f}"),
        ("Mag_Raw", "F11.3", "UNIT=nT:NULL=-99999.999", "NAME=Total field, raw", None),
        ("Flux", "3F11.2", "UNIT=nT:NULL=-999999.99", "NAME=Fluxgate x y z", None),
        ("Depth", "F8.2", "UNIT=m:NULL=-999.99", "NAME=Depth", lambda r: f"{r.depth_m:8.2f}"),
    ]
    special = {
        "Time_UTC": lambda r: f"{np.mod(START_OF_DAY_S + r.time_s, 86400.0):10.1f}",
        "Mag_Raw": lambda r: f"{-99999.999 if r.Index in (30, 31) else r.scalar_nT:11.3f}",
        "Flux": lambda r: f"{r.flux_x_nT:11.2f}{r.flux_y_nT:11.2f}{r.flux_z_nT:11.2f}",
    }
    dfn = "DEFN   ST=RECD,RT=COMM;RT:A4;COMMENTS:A76\n"
    for index, (name, form, attributes, label, _) in enumerate(definitions):
        dfn += f"DEFN {index + 1:2d} ST=RECD,RT=;{name}:{form}:{attributes},{label}\n"
    dfn += f"DEFN {len(definitions) + 1:2d} ST=RECD,RT=;END DEFN\n"
    save("aseg.dfn", dfn)
    writers = [special.get(name, write) for name, _, _, _, write in definitions]
    save("aseg.dat", "".join("".join(write(row) for write in writers) + "\n" for row in TRUTH[:SHORT].itertuples()))
    more = {"companions": ["aseg.dfn"], "missing": {"scalar_nT": [30, 31]}, "findings": ["dummies"]}
    columns = {**OURS, "depth_m": 0.0051, "latitude_deg": 0.6e-7, "longitude_deg": 0.6e-7}
    imported("aseg.dat", "ASEG-GDF2 with its definition", columns, rows=SHORT, time_offset_s=START.timestamp(), **more)
    save("aseg_alone.dat", "".join("".join(write(row) for write in writers) + "\n" for row in TRUTH[:20].itertuples()))
    alone = {"rows": 20, "time_offset_s": START_OF_DAY_S, "findings": ["choice"]}
    imported("aseg_alone.dat", "ASEG-GDF2 without its definition: columns by their values", **alone)


def iaga_2002():
    head = [
        ("Format", "IAGA-2002"),
        ("Source of Data", "A made-up observatory"),
        ("Station Name", "Towed body"),
        ("IAGA CODE", "TWB"),
        ("Geodetic Latitude", "49.100"),
        ("Geodetic Longitude", "32.900"),
        ("Elevation", "70"),
        ("Reported", "XYZF"),
        ("Sensor Orientation", "XYZF"),
        ("Digital Sampling", "1 second"),
        ("Data Interval Type", "1-second"),
        ("Data Type", "variation"),
    ]
    text = "".join(f" {key:<23}{value:<45}|\n" for key, value in head)
    text += " # A comment of the station                                          |\n"
    text += "DATE       TIME         DOY     TWBX      TWBY      TWBZ      TWBF   |\n"
    long = tow(np.arange(120.0), None)
    long[["time_s", *OURS]].to_csv(HERE / "truth_1hz.csv.gz", index=False, compression={"method": "gzip", "mtime": 0})
    for row in long.itertuples():
        total = 99999.0 if row.Index in (5, 6) else row.scalar_nT
        values = (row.flux_x_nT, row.flux_y_nT, row.flux_z_nT, total)
        text += stamp(row, "%Y-%m-%d %H:%M:%S.000 %j   ") + "".join(f"{value:10.2f}" for value in values) + "\n"
    save("iaga2002.sec", text)
    more = {"truth": "truth_1hz.csv.gz", "rows": 120, "source_rate_hz": 1.0, "missing": {"scalar_nT": [5, 6]}}
    columns = {n: 0.0051 for n in OURS}
    imported("iaga2002.sec", "IAGA-2002, seconds", columns, time_offset_s=START.timestamp(), **more)


def sentence(body):
    check = 0
    for byte in body.encode():
        check ^= byte
    return f"${body}*{check:02X}\n"


def degrees_minutes(value, width, positive, negative):
    size = abs(value)
    return f"{int(size):0{width}d}{(size - int(size)) * 60:08.5f},{positive if value >= 0 else negative}"


def nmea():
    text = ""
    for row in TRUTH.iloc[::5].itertuples():
        place = degrees_minutes(row.latitude_deg, 2, "N", "S") + "," + degrees_minutes(row.longitude_deg, 3, "E", "W")
        clock = stamp(row, "%H%M%S.%%10")
        text += sentence(f"GPRMC,{clock},A,{place},3.9,{row.heading_deg:.1f},{stamp(row, '%d%m%y')},8.5,E")
        text += sentence(f"GPGGA,{clock},{place},4,12,0.8,70.0,M,20.0,M,,")
    text = text.replace("$GPGGA", "$GPGGX", 1)  # its checksum is wrong now
    save("track.nmea", text)
    place = {"latitude_deg": 2e-7, "longitude_deg": 2e-7}
    more = {"every": 5, "rows": 80, "absent": ["scalar_nT", "flux_x_nT"], "findings": ["missing"]}
    more["time_offset_s"] = START.timestamp()
    imported("track.nmea", "NMEA 0183, RMC and GGA, one sentence damaged", place, **more)


def maglog():
    columns = [
        ("Date", lambda row: stamp(row, "%m/%d/%y")),
        ("Time", lambda row: stamp(row, "%H:%M:%S.%%1")),
        ("RAWMAG", number(3, "scalar_nT")),
        ("SIGNAL", lambda row: str(1100 + row.Index % 17)),
        ("DEPTH", number(2, "depth_m")),
        ("ALT", number(2, "altitude_m")),
        ("LAT", number(7, "latitude_deg")),
        ("LON", number(7, "longitude_deg")),
        ("FLUX1X", number(2, "flux_x_nT")),
        ("FLUX1Y", number(2, "flux_y_nT")),
        ("FLUX1Z", number(2, "flux_z_nT")),
        ("LINE", lambda row: f"L{row.line}"),
    ]
    save("maglog.csv", delimited(columns), newline="\r\n")
    whole = {**OURS, "depth_m": 0.0051, "altitude_m": 0.0051, "latitude_deg": 0.6e-7, "longitude_deg": 0.6e-7}
    imported("maglog.csv", "as a logger of a marine magnetometer", whole, rows=SHORT, time_offset_s=START.timestamp())


# -------------------------------------------------------------------------------------------------- HDF5 and MATLAB


def magnav(table, survey=2020, all_fields=True):
    """A recording as the fields of the MagNav data sets; what the recording lacks is made plausible, or left out."""
    rows = len(table)
    of = lambda name: table[name].to_numpy(float) if name in table else None
    vector = [of(f"flux_{a}_nT") for a in "xyz"]
    fields = {"tt": of("time_s"), "lat": of("latitude_deg"), "lon": of("longitude_deg"), "msl": of("altitude_m")}
    fields |= {"depth": of("depth_m"), "mag_1_uc": of("scalar_nT"), "mag_2_uc": of("scalar2_nT")}
    fields |= {"diurnal": of("base_nT"), "temperature": of("temperature_degC")}
    fields |= {f"flux_a_{a}": v for a, v in zip("xyz", vector)}
    if all(v is not None for v in vector):
        fields["flux_a_t"] = np.sqrt(sum(v**2 for v in vector))
    fields |= {f"ins_{a}": of(f"{n}_deg") for a, n in (("roll", "roll"), ("pitch", "pitch"), ("yaw", "heading"))}
    fields |= {f"cur_{n[8:-2]}": of(n) for n in table.columns if re.fullmatch(r"current_.*_A", n)}
    if "line" in table:
        codes = pd.to_numeric(table["line"], errors="coerce")
        fields["line"] = (codes if codes.notna().all() else pd.factorize(table["line"])[0] + 1.0) * 1.0
    if all_fields:
        fields |= {"flight": np.full(rows, 1002.0), "year": np.full(rows, 2024.0), "doy": np.full(rows, 138.0)}
        fields |= {"ins_lat": np.radians(fields["lat"]), "ins_lon": np.radians(fields["lon"])}
        fields |= {"igrf": np.full(rows, 50000.0), "diurnal": np.full(rows, 3.0)}
        for sensor in range(2, 7 if survey == 2020 else 6):
            fields[f"mag_{sensor}_uc"] = fields["mag_1_uc"] + 10.0 * sensor
        for sensor, shift in (("b", 5.0), ("c", -5.0), ("d", 11.0)):
            fields |= {f"flux_{sensor}_{a}": fields[f"flux_a_{a}"] + shift for a in "xyzt"}
        if survey == 2020:
            fields |= {"cur_tank": np.full(rows, 0.4), "vol_bat": np.full(rows, 27.5)}
    return {name: np.asarray(values) for name, values in fields.items() if values is not None}


def write_hdf5(path, fields, kind="f8", **storage):
    with h5py.File(path, "w") as file:
        fill_hdf5(file, fields, kind, **storage)


def fill_hdf5(group, fields, kind, **storage):
    rows = len(fields["tt"])
    group.create_dataset("N", data=rows)
    group.create_dataset("dt", data=float(np.round(np.median(np.diff(fields["tt"])), 6)))
    for name, values in fields.items():
        # Time in f32 would not keep tenths of a second of a day.
        group.create_dataset(name, data=values.astype("f8" if name == "tt" else kind), **storage)


def hdf5():
    table = TRUTH.copy()
    table["time_s"] += START_OF_DAY_S
    exact = {n: 1e-9 for n in (*OURS, "roll_deg", "pitch_deg", "latitude_deg", "longitude_deg", "depth_m")}
    packed = {"compression": "gzip", "shuffle": True}
    more = {"time_offset_s": START_OF_DAY_S, "findings": ["choice"]}
    write_hdf5(HERE / "magnav_2020.h5", magnav(table.head(SHORT)), **packed)
    data = (HERE / "magnav_2020.h5").read_bytes()
    (HERE / "magnav_2020.h5").unlink()
    (HERE / "magnav_2020.h5.gz").write_bytes(gzip.compress(data, mtime=0))
    words = "MagNav HDF5, fields of 2020, deflate and shuffle, in gzip"
    imported("magnav_2020.h5.gz", words, exact, rows=SHORT, **more)
    few = lambda t, *drop: {n: v for n, v in magnav(t, all_fields=False).items() if n not in drop}
    start = {"time_offset_s": START_OF_DAY_S}
    least = few(table.head(100), "line", "msl", "temperature", "cur_strobe")
    write_hdf5(HERE / "magnav_deflate.h5", least, **packed)
    imported("magnav_deflate.h5", "MagNav HDF5, few fields, deflate and shuffle", exact, rows=100, **start)
    write_hdf5(HERE / "magnav_2021.h5", magnav(table.head(60), 2021))
    imported("magnav_2021.h5", "MagNav HDF5, fields of 2021, not compressed", exact, rows=60, **more)
    write_hdf5(HERE / "magnav_f32.h5", few(table.head(SHORT)), "f4")
    single = {"scalar_nT": 0.004, "flux_x_nT": 0.004, "flux_y_nT": 0.004, "flux_z_nT": 0.004, "depth_m": 1e-6}
    imported("magnav_f32.h5", "MagNav HDF5 in f32", single, rows=SHORT, **start)
    with h5py.File(HERE / "magnav_1_14.h5", "w", libver=("v114", "v114")) as file:
        fill_hdf5(file, few(table.head(SHORT)), "f8", chunks=(64,), fletcher32=True, **packed)
    words = "HDF5 of version 1.14, chunks of 64 rows, checksums"
    imported("magnav_1_14.h5", words, exact, rows=SHORT, **start)
    with h5py.File(HERE / "magnav_groups.h5", "w") as file:
        for name, part in (("flt1002", table.head(40)), ("flt1003", table.iloc[100:140])):
            fill_hdf5(file.create_group(name), few(part), "f8")
    more = {"rows": 40, "first": 100, "time_offset_s": START_OF_DAY_S, "part": "flt1003"}
    imported("magnav_groups.h5", "HDF5 with a group a flight", exact, **more)
    missing = few(table.head(100))
    missing["mag_1_uc"] = missing["mag_1_uc"].copy()
    missing["mag_1_uc"][[10, 11]] = np.nan
    missing["mark"] = np.arange(100)
    with h5py.File(HERE / "magnav_mixed.h5", "w") as file:
        left = {n: v for n, v in missing.items() if n not in ("line", "mark", "msl", "temperature", "cur_strobe")}
        fill_hdf5(file, left, "f8")
        file["line"] = missing["line"].astype("i4")
        file["mark"] = missing["mark"].astype(">u2")
        file["note"] = np.array([f"row {n % 3}" for n in range(100)], dtype="S8")
        file["remark"] = [f"r{n % 3}" for n in range(100)]
        file["flag"] = np.arange(100) % 2 == 0
        file["picture"] = np.zeros((4, 5))
    more = {"missing": {"scalar_nT": [10, 11]}, **start}
    imported("magnav_mixed.h5", "HDF5 with integers, texts, a picture, NaN", exact, rows=100, **more)
    data = (HERE / "magnav_1_14.h5").read_bytes()
    (HERE / "magnav_cut.h5").write_bytes(data[: len(data) // 3])
    refused("magnav_cut.h5", "HDF5, cut", ["cut"])


def quiet_mat(path):
    """scipy puts the time of writing into the header."""
    data = bytearray(path.read_bytes())
    data[:116] = b"MATLAB 5.0 MAT-file, made by scipy.io.savemat".ljust(116)
    path.write_bytes(data)


def mat():
    table = TRUTH.head(SHORT).copy()
    table["time_s"] += START_OF_DAY_S
    fields = magnav(table, all_fields=False)
    exact = {n: 1e-9 for n in (*OURS, "roll_deg", "pitch_deg", "latitude_deg", "longitude_deg", "depth_m")}
    more = {"rows": SHORT, "time_offset_s": START_OF_DAY_S}
    shapes = (("mat_struct.mat", {"xyz": {**fields, "dt": 0.1, "N": SHORT}}, "column", True, "a struct, compressed"),)
    shapes += (("mat_flat.mat", {**fields, "dt": 0.1}, "row", True, "row vectors, compressed"),)
    plain_fields = {n: fields[n] for n in ("tt", "mag_1_uc", "flux_a_x", "flux_a_y", "flux_a_z", "depth")}
    plain_fields |= {"line": fields["line"].astype(np.int16), "label": np.array(["a tow"])}
    shapes += (("mat_plain.mat", plain_fields, "column", False, "column vectors, not compressed, integers, text"),)
    for file, content, oned_as, packed, words in shapes:
        scipy.io.savemat(HERE / file, content, do_compression=packed, oned_as=oned_as)
        quiet_mat(HERE / file)
        want = {n: exact[n] for n in (*OURS, "depth_m")} if file == "mat_plain.mat" else exact
        imported(file, f"MATLAB 5, {words}", want, **more)
    few = {n: v[:30] for n, v in fields.items()}
    xyz = {"traj": {"N": 30, "dt": 0.1, **{n: few[n] for n in ("tt", "lat", "lon")}}}
    xyz["ins"] = {n: np.radians(few[n]) for n in ("lat", "lon")}
    xyz["flux_a"] = {axis: few[f"flux_a_{axis}"] for axis in "xyz"}
    xyz |= {"mag_1_uc": few["mag_1_uc"], "what": np.array(["leg"] * 20 + ["turn"] * 10)}
    nested = {"xyz": xyz, "matrix": np.arange(120.0).reshape(40, 3)}
    scipy.io.savemat(HERE / "mat_nested.mat", nested, do_compression=True, oned_as="column")
    quiet_mat(HERE / "mat_nested.mat")
    want = {n: exact[n] for n in (*OURS, "latitude_deg")}
    imported("mat_nested.mat", "MATLAB 5, structs as MagNav.jl has them", want, **(more | {"rows": 30}))
    # MATLAB 7.3 is HDF5 behind a block of 512 bytes, with vectors as 1 x N.
    with h5py.File(HERE / "mat_73.mat", "w", userblock_size=512) as file:
        for name, values in plain_fields.items():
            if name != "label":
                dataset = file.create_dataset(name, data=np.asarray(values)[None, :])
                dataset.attrs["MATLAB_class"] = np.bytes_("double" if values.dtype == float else "int16")
    block = b"MATLAB 7.3 MAT-file, made by h5py".ljust(124) + struct.pack("<H", 0x0200) + b"IM"
    data = bytearray((HERE / "mat_73.mat").read_bytes())
    data[:128] = block
    (HERE / "mat_73.mat").write_bytes(data)
    imported("mat_73.mat", "MATLAB 7.3", {n: exact[n] for n in (*OURS, "depth_m")}, **more)
    (HERE / "mat_cut.mat").write_bytes((HERE / "mat_flat.mat").read_bytes()[:6000])
    refused("mat_cut.mat", "MATLAB 5, cut", ["cut"])


# ----------------------------------------------------------------------------------------------------- spreadsheets


def repack(path):
    """The same bytes on every run: no time of writing in the archive, nor in its properties."""
    content = []
    with zipfile.ZipFile(path) as archive:
        for entry in archive.infolist():
            data = archive.read(entry)
            if entry.filename in ("docProps/core.xml", "meta.xml"):
                data = re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z?", b"2024-05-17T00:00:00Z", data)
            content.append((entry.filename, entry.compress_type, data))
    with zipfile.ZipFile(path, "w") as archive:
        for name, method, data in content:
            archive.writestr(zipfile.ZipInfo(name), data, method, 9)


def sheet_table(rows):
    table = TRUTH.head(rows)[["time_s", *OURS]]
    return table.rename(columns=lambda name: name.rsplit("_", 1)[0])


def spreadsheets():
    exact = {n: 1e-9 for n in OURS}
    with pd.ExcelWriter(HERE / "two_sheets.xlsx", engine="openpyxl") as writer:
        about = pd.DataFrame({"what": ["body", "lake"], "which": ["3", "Kremenchuk"]})
        about.to_excel(writer, sheet_name="About", index=False)
        sheet_table(SHORT).to_excel(writer, sheet_name="Tow", index=False)
    repack(HERE / "two_sheets.xlsx")
    more = {"rows": SHORT, "time_offset_s": 0.0, "findings": ["choice"]}
    imported("two_sheets.xlsx", "xlsx, the second sheet has the data", exact, **more)
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Log"
    sheet.append(["Towed body 3"])
    sheet.append([])
    sheet.append(["Time", "Scalar", "Flux X", "Flux Y", "Flux Z", "Depth"])
    sheet.append(["UTC", "nT", "nT", "nT", "nT", "m"])
    for row in TRUTH.head(SHORT).itertuples():
        moment = (START + timedelta(seconds=row.time_s)).replace(tzinfo=None)
        sheet.append([moment, row.scalar_nT, row.flux_x_nT, row.flux_y_nT, row.flux_z_nT, row.depth_m])
        sheet.cell(sheet.max_row, 1).number_format = "yyyy-mm-dd hh:mm:ss.0"
    sheet["B12"] = None
    book.save(HERE / "units_row.xlsx")
    repack(HERE / "units_row.xlsx")
    more = {"rows": SHORT, "time_offset_s": START.timestamp(), "missing": {"scalar_nT": [7]}}
    imported("units_row.xlsx", "xlsx with dates, a row of units, a title", {**exact, "depth_m": 1e-9}, **more)
    with pd.ExcelWriter(HERE / "tow.ods", engine="odf") as writer:
        sheet_table(SHORT).to_excel(writer, sheet_name="Tow", index=False)
    repack(HERE / "tow.ods")
    imported("tow.ods", "ods", exact, rows=SHORT, time_offset_s=0.0)
    book = xlwt.Workbook()
    sheet = book.add_sheet("Tow")
    clock = xlwt.easyxf(num_format_str="hh:mm:ss.0")
    for column, name in enumerate(["clock", *list(sheet_table(1).columns)[1:]]):
        sheet.write(0, column, name)
    for index, row in enumerate(sheet_table(100).itertuples(index=False), 1):
        sheet.write(index, 0, (36000.0 + row[0]) / 86400.0, clock)
        for column, value in enumerate(row[1:], 1):
            sheet.write(index, column, float(value))
    book.save(str(HERE / "tow.xls"))
    imported("tow.xls", "xls of 1997, times of day", exact, rows=100, time_offset_s=36000.0)
    data = (HERE / "two_sheets.xlsx").read_bytes()
    (HERE / "cut.xlsx").write_bytes(data[: len(data) * 2 // 3])
    refused("cut.xlsx", "xlsx, cut", ["cut"])
    with zipfile.ZipFile(HERE / "bomb.xlsx", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        archive.writestr(zipfile.ZipInfo("xl/worksheets/sheet1.xml"), b" " * 16_100_000, zipfile.ZIP_DEFLATED, 9)
    refused("bomb.xlsx", "a small archive with 16.1 MB of blanks", ["larger"])


# ----------------------------------------------------------------------------------------------------------- damage


def damaged():
    random = np.random.RandomState(5)
    (HERE / "random.bin").write_bytes(random.bytes(4096))
    refused("random.bin", "random bytes", [])
    data = (HERE / "packed.csv.gz").read_bytes()
    (HERE / "cut.csv.gz").write_bytes(data[: len(data) // 2])
    cut = {"rows": 195, "time_offset_s": START_OF_DAY_S, "invalid": [194]}
    imported("cut.csv.gz", "gzip, cut: what comes before the cut is there", findings=["truncated"], **cut)
    for file in ("magnav_f32.h5", "mat_struct.mat", "tow.ods", "tow.xls"):
        data = bytearray((HERE / file).read_bytes())
        # Behind what tells the format.
        for place in random.randint(512, len(data), len(data) // 50):
            data[place] ^= 1 << random.randint(0, 8)
        stem, ending = file.rsplit(".", 1)
        (HERE / f"damaged_{stem}.{ending}").write_bytes(data)
        refused(f"damaged_{stem}.{ending}", f"{file} with a bit changed in one byte of fifty", [])


def flight(recording, out):
    """Writes a recording of this project as MagNav HDF5 in f64."""
    table = pd.read_csv(recording)
    write_hdf5(out, magnav(table, all_fields=False))


def main():
    TRUTH.to_csv(HERE / "truth.csv", index=False)
    for make in (text_dialects, time_dialects, unit_dialects, faulty_text, swapped_axes, faster_samplers):
        make()
    for make in (geosoft_xyz, aseg_gdf2, iaga_2002, nmea, maglog, hdf5, mat, spreadsheets, damaged):
        make()
    write_manifest()


if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[1] == "flight":
        flight(sys.argv[2], sys.argv[3])
    elif len(sys.argv) == 1:
        main()
    else:
        sys.exit(__doc__)
