// What is known: the cells of the window that is shown, the track, marks and contacts. The server has the same and more:
// whatever is missing here is asked for again.
const WINDOWS = [[120, "2 min"], [600, "10 min"], [3600, "1 h"], [10800, "3 h"], [43200, "12 h"]];
const SERIES = 6;
const MOST_POINTS = 8000;
const store = {
  window: settings.get("window", 600), cell: 0.5, time: [], low: [], high: [], track: [], marks: [], contacts: [], texts: [],
  last: null, latest: new Array(SERIES).fill(null), battery: null, place: null, sent: null,
  clear() {
    Object.assign(this, { time: [], low: [], high: [], track: [], marks: [], contacts: [], last: null, place: null });
  },
  // A body that does not know the time stamps nothing; when it was read is as good but for the cable.
  row([time, sent, series, place, battery, heard]) {
    if (this.last != null && time < this.last) return;
    Object.assign(this, { last: time, sent: sent ?? heard, latest: series, battery });
    const end = this.time.length - 1;
    // A new cell when the last is over, as on the server; a twentieth is for what is rounded.
    if (end < 0 || time - this.time[end] >= 0.95 * this.cell) {
      this.time.push(time);
      this.low.push(series.slice());
      this.high.push(series.slice());
    } else {
      series.forEach((value, k) => this.widen(end, k, value));
    }
    if (place) this.point({ time_s: time, latitude_deg: place[0], longitude_deg: place[1] });
    this.place = place;
  },
  widen(cell, k, value) {
    if (value == null) return;
    if (this.low[cell][k] == null || value < this.low[cell][k]) this.low[cell][k] = value;
    if (this.high[cell][k] == null || value > this.high[cell][k]) this.high[cell][k] = value;
  },
  point(point) {
    const last = this.track[this.track.length - 1];
    if (last && point.time_s - last.time_s < 1) return;
    this.track.push(point);
    if (this.track.length > MOST_POINTS) this.track = this.track.filter((_, k) => k % 2 === 0);
  },
  history(told) {
    if (told.window_s !== this.window) return; // of the window before
    this.cell = told.cell_s;
    const begin = told.since_s == null ? -Infinity : told.time_s[0] ?? Infinity;
    const kept = told.since_s == null ? 0 : this.time.findIndex((time) => time >= begin - 1e-6);
    const count = kept < 0 ? this.time.length : kept;
    this.time = this.time.slice(0, count).concat(told.time_s);
    this.low = this.low.slice(0, count).concat(told.low);
    this.high = this.high.slice(0, count).concat(told.high);
    const from = told.since_s ?? -Infinity;
    this.track = this.track.filter((point) => point.time_s <= from).concat(told.track);
    const newest = this.time[this.time.length - 1];
    if (newest != null && (this.last == null || newest > this.last)) {
      this.last = newest;
      this.latest = this.high[this.high.length - 1].slice();
    }
  },
  trim() {
    const first = this.time.findIndex((time) => time >= this.last - this.window - this.cell);
    if (first > 200) for (const list of [this.time, this.low, this.high]) list.splice(0, first - 1);
  },
  // Notices come again after each connection.
  add(list, notice) {
    if (list.some((old) => JSON.stringify(old) === JSON.stringify(notice))) return false;
    list.push(notice);
    if (list.length > 500) list.shift();
    return true;
  },
};
