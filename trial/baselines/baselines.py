"""Two general methods on the recordings of a trial, beside what `diagnose` says of them.

    host-sim trial --only foreign --recordings 200 --minutes 4 --seed 702 --keep --out trial
    pip install -r trial/baselines/requirements.txt
    python trial/baselines/baselines.py target/release/host-sim trial

Sparse regression (`pysindy`: STLSQ over products of the inputs) and a Gaussian process with a length scale for each input
(`scikit-learn`: relevance determination). Both get the residual that `diagnose` describes (`gap.csv`: without the 18 terms, a slow
background and the rows of large targets), the same inputs, and one thing that a diagnosis does not get: the true noise. With a preparation of their
own they "close" all of what that leaves, on recordings that hide nothing too. Driver: the input to which most of the prediction goes. Share:
what the prediction closes of the excess over the noise on every fourth 5 s, which it was not fitted to; of `diagnose` what it says itself, 0
where it proposes nothing.
"""

import argparse
import json
import subprocess
import tempfile
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pysindy
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

RATE_HZ = 10.0
BACKGROUND_HZ = 0.02
FOLDS = 4
FOLD_S = 5.0
NOT_RECORDED = {"none", "time_periodic", "time_irregular"}
GP_POINTS = 500
# Of the excess on parts held out: a method that closes less has found nothing.
LEAST_CLOSED = 0.05
AXES = ["flux_x_nT", "flux_y_nT", "flux_z_nT"]
TILT = ["roll_deg", "pitch_deg"]


def low_passed(values, time_constant_s):
    """First order, along the first axis."""
    keep = np.exp(-1.0 / (RATE_HZ * time_constant_s))
    out = np.empty_like(values)
    out[0] = values[0]
    for row in range(1, len(values)):
        out[row] = keep * out[row - 1] + (1.0 - keep) * values[row]
    return out


def terms(direction, rate, field_nt):
    """The 18 columns of Tolles and Lawson, per 50,000 nT."""
    pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
    scale = field_nt / 50_000.0
    induced = [scale * direction[:, i] * direction[:, j] for i, j in pairs]
    eddy = [scale * direction[:, i] * rate[:, j] for i in range(3) for j in range(3)]
    return np.column_stack([*direction.T, *induced, *eddy])


def background(rows):
    """Cosines slower than the background."""
    count = max(1, int(2 * BACKGROUND_HZ * rows / RATE_HZ))
    at = (np.arange(rows) + 0.5) / rows
    return np.cos(np.pi * np.outer(at, np.arange(count + 1)))


def inputs_of(recording, direction, rate, scalar_nt):
    """Columns of each input by its name."""
    # By an attitude sensor, where there is one.
    tilt = recording[[name for name in TILT if name in recording]].to_numpy()
    attitude = np.hstack([direction, tilt])
    inputs = {"attitude": attitude, "attitude_rate": np.hstack([rate, np.gradient(tilt, axis=0) * RATE_HZ])}
    inputs["attitude_history"] = np.column_stack([low_passed(attitude, tau_s) for tau_s in (2.0, 10.0, 30.0)])
    inputs["reading"] = np.column_stack([np.gradient(scalar_nt) * RATE_HZ])
    if "depth_m" in recording:
        inputs["depth"] = recording[["depth_m"]].to_numpy()
        inputs["depth_rate"] = np.gradient(inputs["depth"], axis=0) * RATE_HZ
    if "temperature_degC" in recording:
        inputs["temperature"] = recording[["temperature_degC"]].to_numpy()
    for name in recording.columns:
        if name.startswith("current_") and name.endswith("_A"):
            inputs[name] = recording[[name]].to_numpy()
    return {name: standardised(columns) for name, columns in inputs.items()}


def standardised(columns):
    spread = columns.std(axis=0)
    return (columns - columns.mean(axis=0)) / np.where(spread > 0, spread, 1.0)


def residual_nt(program, file, channel):
    """What `diagnose` is left with, one value a row; not a number where it left the row out."""
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([program, "--quiet", "diagnose", file, "--out", out], check=True, stdout=subprocess.DEVNULL)
        return pd.read_csv(Path(out) / "gap.csv")[f"{channel}_before_nT"].to_numpy()


class Problem:
    """What is left of one channel of a recording, and the inputs that may drive it."""

    def __init__(self, program, file, answer, channel):
        recording = pd.read_csv(file)
        numbers = recording.apply(pd.to_numeric, errors="coerce")
        left_nt = residual_nt(program, file, channel)
        good = numbers[["scalar_nT", *AXES]].notna().all(axis=1) & np.isfinite(left_nt)
        numbers = numbers[good].interpolate(limit_direction="both").dropna(axis="columns", how="all")
        flux = numbers[AXES].to_numpy()
        magnitude_nt, scalar_nt = np.linalg.norm(flux, axis=1), numbers["scalar_nT"].to_numpy()
        direction = low_passed((flux / magnitude_nt[:, None]), 0.05)
        rate = np.gradient(direction, axis=0) * RATE_HZ
        slow, is_scalar = background(len(numbers)), channel == "scalar"
        self.nuisance = np.hstack([slow, terms(direction, rate, scalar_nt)]) if is_scalar else slow
        self.noise_nt = answer["noise_rms_nT" if is_scalar else "fluxgate_noise_rms_nT"]
        self.left_nt = left_nt[good]
        self.inputs = inputs_of(numbers, direction, rate, scalar_nt)
        fold = (np.arange(len(numbers)) / (FOLD_S * RATE_HZ)).astype(int) % FOLDS
        self.folds = [fold == k for k in range(FOLDS)]

    @staticmethod
    def projected(nuisance, columns):
        fitted, *_ = np.linalg.lstsq(nuisance, columns, rcond=None)
        return columns - nuisance @ fitted

    def all_inputs(self):
        """All columns side by side, and the name of each."""
        names = [name for name, columns in self.inputs.items() for _ in range(columns.shape[1])]
        return np.hstack(list(self.inputs.values())), np.array(names)

    def closed(self, predicted_nt):
        """Share of the excess that a prediction of parts held out closes."""
        excess = np.mean(self.left_nt**2) - self.noise_nt**2
        gone = np.mean(self.left_nt**2) - np.mean((self.left_nt - predicted_nt) ** 2)
        return float(np.clip(gone / excess, -1.0, 1.0)) if excess > 0 else 0.0


def sparse_regression(problem):
    """STLSQ over products of two inputs and squares, columns beside 18 terms and background."""
    columns, names = problem.all_inputs()
    library = pysindy.PolynomialLibrary(degree=2, include_bias=False).fit(columns)
    features = np.asarray(library.transform(columns))
    owners = [{names[k] for k in np.flatnonzero(powers)} for powers in np.asarray(library.powers_)]
    features = standardised(problem.projected(problem.nuisance, features))
    features[:, np.std(features, axis=0) < 1e-6] = 0.0

    def fitted(rows):
        optimizer = pysindy.STLSQ(threshold=0.3 * problem.noise_nt, alpha=1.0, max_iter=10)
        optimizer.fit(features[rows], problem.left_nt[rows])
        return np.ravel(optimizer.coef_)

    predicted_nt = np.zeros_like(problem.left_nt)
    for held_out in problem.folds:
        predicted_nt[held_out] = features[held_out] @ fitted(~held_out)
    weights = fitted(np.ones(len(features), bool)) ** 2
    shares = {}
    for owner, weight in zip(owners, weights):
        for name in owner:
            shares[name] = shares.get(name, 0.0) + weight / len(owner)
    return named(shares, problem.closed(predicted_nt))


def gaussian_process(problem):
    """A length scale for each input column; on points drawn evenly, because its cost grows with their cube."""
    columns, names = problem.all_inputs()
    spread = problem.left_nt.std()

    def fitted(rows):
        chosen = np.flatnonzero(rows)
        chosen = chosen[np.linspace(0, len(chosen) - 1, min(GP_POINTS, len(chosen))).astype(int)]
        noise = (problem.noise_nt / spread) ** 2
        kernel = ConstantKernel(1.0) * RBF(np.ones(columns.shape[1]), (0.1, 1e3)) + WhiteKernel(noise, (noise / 10, 10.0))
        process = GaussianProcessRegressor(kernel, normalize_y=False, n_restarts_optimizer=0)
        return process.fit(columns[chosen], problem.left_nt[chosen] / spread)

    process = fitted(np.ones(len(columns), bool))
    # The length scales of all points serve the folds: fitting them anew would only cost time.
    predicted_nt = np.zeros_like(problem.left_nt)
    for held_out in problem.folds:
        chosen = np.flatnonzero(~held_out)
        chosen = chosen[np.linspace(0, len(chosen) - 1, min(2 * GP_POINTS, len(chosen))).astype(int)]
        own = GaussianProcessRegressor(process.kernel_, optimizer=None).fit(columns[chosen], problem.left_nt[chosen] / spread)
        predicted_nt[held_out] = spread * own.predict(columns[held_out])
    relevance = 1.0 / process.kernel_.k1.k2.length_scale ** 2
    shares = {name: float(relevance[names == name].max()) for name in problem.inputs}
    return named(shares, problem.closed(predicted_nt))


def named(shares, closed):
    """The input with the largest share, and what is closed; `none` where that is nothing."""
    driver = max(shares, key=shares.get) if shares and closed > LEAST_CLOSED else "none"
    return driver, max(closed, 0.0)


def said_by_diagnose(result):
    rest = result["diagnosis"].get("unexplained")
    drivers = rest.get("drivers", []) if isinstance(rest, dict) else []
    closed = (rest.get("gap_closed") or {}).get("fraction", 0.0) if isinstance(rest, dict) else 0.0
    return (drivers[0]["input"] if drivers else "none"), closed


def is_right(driver, drivers):
    return driver in drivers if drivers else driver in NOT_RECORDED


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="host-sim")
    parser.add_argument("trial", type=Path, help="folder of a trial that was run with --keep")
    parser.add_argument("--most", type=int, default=None, help="recordings that are tried at most: each takes some seconds")
    options = parser.parse_args()
    answers = json.loads((options.trial / "answers.json").read_text())
    results = json.loads((options.trial / "trial.json").read_text())["results"]
    methods = {"diagnose": None, "sparse regression (pysindy)": sparse_regression, "Gaussian process": gaussian_process}
    scores = {name: {"recorded": [], "unrecorded": [], "closed": []} for name in methods}
    strong = [pair for pair in zip(answers, results) if len(pair[0]["hidden"]) == 1 and pair[0]["hidden"][0]["strength"] >= 2.4]
    for answer, result in strong[: options.most]:
        drivers = answer.get("drivers", [])
        channel = result["diagnosis"]["gap"]["channel"]
        problem = Problem(options.program, options.trial / "recordings" / f"{answer['index']:03}.csv", answer, channel)
        for name, method in methods.items():
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                driver, closed = said_by_diagnose(result) if method is None else method(problem)
            scores[name]["recorded" if drivers else "unrecorded"].append(is_right(driver, drivers))
            if drivers and not answer.get("is_random", False):
                scores[name]["closed"].append(closed)
    print("| | right driver first, one recorded | `none` or a driver in time, none recorded | share closed, median | mean |")
    print("|---|---|---|---|---|")
    for name, score in scores.items():
        rates = [f"{sum(score[kind])} of {len(score[kind])}" for kind in ("recorded", "unrecorded")]
        shares = [f"{of(score['closed']):.2f}" if score["closed"] else "-" for of in (np.median, np.mean)]
        print(f"| {name} | {' | '.join([*rates, *shares])} |")


if __name__ == "__main__":
    main()
