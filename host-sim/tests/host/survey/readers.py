"""The map of a survey as GDAL sees it, against levelled.csv and summary.json.

    python readers.py FOLDER      what `host-sim survey` wrote
"""

import csv
import json
import math
import sys
from pathlib import Path

import numpy
import pyogrio
import rasterio
import rasterio.warp
import shapely


def layer(path):
    """Geometries and columns."""
    metadata, _, geometries, columns = pyogrio.raw.read(path)
    assert metadata["crs"] == "EPSG:4326", metadata["crs"]
    return shapely.from_wkb(geometries), dict(zip(metadata["fields"], columns, strict=True))


def main(folder):
    """Raise at the first thing that is not as it was written."""
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    with open(folder / "contacts.csv", newline="", encoding="utf-8") as file:
        contacts = list(csv.DictReader(file))
    if contacts:
        geometries, columns = layer(folder / "contacts.geojson")
        for geometry, snr, row in zip(geometries, columns["snr"], contacts, strict=True):
            assert float(row["snr"]) == snr
            if row["latitude_deg"]:
                assert math.dist(geometry.coords[0], (float(row["longitude_deg"]), float(row["latitude_deg"]))) < 1e-7
    geometries, columns = layer(folder / "track.geojson")
    lines = {name for name, geometry in zip(columns["line"], geometries) if geometry.geom_type == "LineString"}
    assert {"L1", "L2", "L3", "L4"} <= lines, lines
    points = [(geometry.x, geometry.y, anomaly) for geometry, anomaly in zip(geometries, columns["anomaly_nT"])
              if geometry.geom_type == "Point"]
    with rasterio.open(folder / "grid.tif") as grid:
        assert grid.crs.to_epsg() == summary["grid"]["epsg"] == 32632, grid.crs
        assert (grid.width, grid.height) == (summary["grid"]["width"], summary["grid"]["height"])
        assert grid.transform.a == -grid.transform.e == summary["grid"]["cell_m"]
        assert math.isnan(grid.nodata) and grid.dtypes == ("float32",)
        x, y = rasterio.warp.transform("EPSG:4326", grid.crs, [p[0] for p in points], [p[1] for p in points])
        found = numpy.array([value[0] for value in grid.sample(zip(x, y))])
        # Every point of the track is on the map, and its value is about that of the track.
        assert numpy.isfinite(found).all()
        anomaly = numpy.array([p[2] for p in points])
        assert numpy.corrcoef(found, anomaly)[0, 1] > 0.5, numpy.corrcoef(found, anomaly)
        blank = numpy.isnan(grid.read(1)).mean()
        assert 0.02 < blank < 0.999, blank
    print(f"{len(lines)} lines, {len(points)} points, {len(contacts)} contacts, {found.size} places on the grid")


main(Path(sys.argv[1]))
