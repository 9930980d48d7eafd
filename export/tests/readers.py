"""Every exported format, read by the programs that people use, against the CSV file that it was made from.

    python readers.py FOLDER      sample.csv, and beside it sample.xyz, sample.geojson, ...
"""

import csv
import json
import math
import sys
from pathlib import Path

import h5py
import jsonschema
import pyarrow.parquet
import pyogrio
import shapely
from mcap.reader import make_reader

LABELS = {"line", "adaptation", "note"}
FLAGS = {"scalar_valid"}
MAGNAV = {
    "time_s": "tt", "latitude_deg": "lat", "longitude_deg": "lon", "scalar_nT": "mag_1_uc",
    "flux_x_nT": "flux_a_x", "flux_y_nT": "flux_a_y", "flux_z_nT": "flux_a_z", "compensated_nT": "mag_1_c",
}


def expected(name, text):
    """A field of the CSV file; `None` where it is missing, or rubbish in a row that is marked."""
    if text in ("", "rubbish"):
        return None
    if name in LABELS:
        return text
    return text == "1" if name in FLAGS else float(text)


def same(found, wanted, what):
    """Equal to the bit; what is not a number is missing."""
    if isinstance(found, float) and math.isnan(found):
        found = None
    assert found == wanted and (wanted is None) == (found is None), f"{what}: {found!r} is not {wanted!r}"


def parquet(path, rows):
    """pyarrow: Arrow's C++."""
    table = pyarrow.parquet.read_table(path)
    assert table.column_names == list(rows[0])
    assert table.schema.metadata[b"unit:scalar_nT"] == b"nT"
    for found, row in zip(table.to_pylist(), rows, strict=True):
        for name, wanted in row.items():
            same(found[name], wanted, name)
            assert type(found[name]) is type(wanted), name


def hdf5(path, rows):
    """h5py: the HDF Group's C library."""
    with h5py.File(path) as file:
        assert file["N"][()] == len(rows) and file["dt"][()] == 0.1
        assert file["mag_1_uc"].attrs["unit"] == "nT"
        assert file["line"][:].tolist() == [101, 101, 101, 1, 2, 2, 102]
        for name in rows[0]:
            if name == "line":
                found = [text.decode() or None for text in file["line_label"][:]]
            elif name in LABELS:
                found = [text.decode() or None for text in file[name][:]]
            else:
                found = file[MAGNAV.get(name, name)][:].tolist()
            for value, row in zip(found, rows, strict=True):
                same(value, row[name], name)


def mcap(path, rows):
    """Foxglove's reader for Python; each message fits its schema."""
    with open(path, "rb") as file:
        reader = make_reader(file)
        statistics = reader.get_summary().statistics
        assert statistics.message_count == 13 and statistics.channel_count == 2
        readings, fixes = [], []
        for schema, channel, message in reader.iter_messages():
            assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            content = json.loads(message.data)
            jsonschema.validate(content, json.loads(schema.data))
            (fixes if channel.topic == "/location" else readings).append((message.log_time, content))
    for number, ((time_ns, found), row) in enumerate(zip(readings, rows, strict=True)):
        assert time_ns == 1_700_000_000_000_000_000 + number * 100_000_000
        assert set(found) == {name for name, wanted in row.items() if wanted is not None}
        for name, wanted in row.items():
            same(found.get(name), wanted, name)
    placed = [row for row in rows if row["latitude_deg"] is not None]
    for (_, fix), row in zip(fixes, placed, strict=True):
        assert (fix["longitude"], fix["latitude"]) == (row["longitude_deg"], row["latitude_deg"])


def layer(path, name):
    """A layer as GDAL sees it, which is what QGIS reads with: its geometries, and its columns."""
    metadata, _, geometries, columns = pyogrio.raw.read(path, layer=name)
    assert "4326" in metadata["crs"], metadata["crs"]
    return shapely.from_wkb(geometries), dict(zip(metadata["fields"], columns, strict=True))


def gpkg(path, rows):
    """GDAL."""
    geometries, columns = layer(path, "samples")
    for number, (geometry, row) in enumerate(zip(geometries, rows, strict=True)):
        place = None if row["latitude_deg"] is None else (row["longitude_deg"], row["latitude_deg"])
        assert (geometry.coords[0] if geometry else None) == place
        for name, wanted in row.items():
            if name in FLAGS:
                # A missing flag makes the column one of doubles there.
                wanted = None if wanted is None else float(wanted)
            found = columns[name][number]
            same(None if found is None else getattr(found, "item", lambda: found)(), wanted, name)
    lines, columns = layer(path, "track")
    assert columns["line"].tolist() == ["101", None, "box 2", "102"] and columns["n"].tolist() == [3, 1, 2, 1]
    assert [len(line.coords) if line else 0 for line in lines] == [3, 0, 2, 0]


def geojson(path, rows):
    """GDAL again; valid geometries with the places of the rows."""
    metadata, _, geometries, columns = pyogrio.raw.read(path)
    columns = dict(zip(metadata["fields"], columns, strict=True))
    points = [at for at, number in enumerate(columns["n"].tolist()) if math.isnan(number)]
    placed = [row for row in rows if row["latitude_deg"] is not None]
    for at, row in zip(points, placed, strict=True):
        assert shapely.from_wkb(geometries[at]).coords[0] == (row["longitude_deg"], row["latitude_deg"])
        same(float(columns["compensated_nT"][at]), row["compensated_nT"], "compensated_nT")
    shapes = [shapely.from_wkb(geometry) for geometry in geometries]
    assert all(shape is None or shape.is_valid for shape in shapes)
    assert [shape.geom_type for shape in shapes if shape and shape.geom_type != "Point"] == ["MultiLineString", "LineString"]


def main(folder):
    """Raise at the first value that is not the one of the CSV file."""
    with open(folder / "sample.csv", newline="", encoding="utf-8") as file:
        rows = [{name: expected(name, text) for name, text in row.items()} for row in csv.DictReader(file)]
    for reader in (parquet, hdf5, mcap, gpkg, geojson):
        reader(folder / f"sample.{reader.__name__}", rows)
        print(f"{reader.__name__}: {len(rows)} rows, {len(rows[0])} columns are the same")


main(Path(sys.argv[1]))
