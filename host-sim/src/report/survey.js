// Reads values off the charts and enlarges the map. Everything is drawn without it.
"use strict";
{
  const plots = [...document.querySelectorAll(".plot")];

  // The points of a path are the data: nothing is stored twice.
  const points = (path) => (path.points ??= path.getAttribute("d").split("M").slice(1)
    .flatMap((run) => run.split(" ").reduce((pairs, value, i, all) => (i % 2 ? [...pairs, [+all[i - 1], +value]] : pairs), [])));

  const nearest = (all, x) => {
    let low = 0, high = all.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (all[middle][0] < x) low = middle; else high = middle;
    }
    return x - all[low][0] < all[high][0] - x ? all[low] : all[high];
  };

  const axis = (text) => {
    const [low, high, ...unit] = text.split(" ");
    return {low: +low, high: +high, unit: unit.join(" ")};
  };
  const at = ({low, high}, share) => low + (high - low) * share;
  const clock = (utc_s) => new Date(utc_s * 1000).toISOString().slice(11, 21);
  const digits = ({low, high}) => Math.max(0, Math.min(6, 2 - Math.floor(Math.log10(high - low))));
  const number = (value, range) => {
    const decimals = digits(range), whole = +value.toFixed(decimals) + 0; // no minus before a zero
    return whole.toLocaleString("en", {minimumFractionDigits: decimals, maximumFractionDigits: decimals}).replace("-", "−");
  };

  for (const plot of plots) {
    const x = axis(plot.dataset.x), y = axis(plot.dataset.y), area = plot.querySelector(".area");
    const out = plot.querySelector("output"), cursor = document.createElement("i");
    cursor.className = "cursor";
    let share = null;
    const read = (to) => {
      share = Math.max(0, Math.min(1, to));
      const lines = [...plot.querySelectorAll("path[data-name]")].filter((path) => points(path).length);
      const found = lines.map((path) => [path.dataset.name, nearest(points(path), 10000 * share)]);
      if (!found.length) return;
      const time = plot.dataset.utc === undefined ? number(at(x, share), x) + " " + x.unit : clock(at(x, share) + +plot.dataset.utc);
      const values = found.map(([name, [, up]]) => `${name} ${number(at(y, 1 - up / 10000), y)} ${y.unit}`.trim());
      out.textContent = `${time}: ${values.join(", ")}`;
      cursor.style.left = 100 * share + "%";
      area.append(cursor);
    };
    area.addEventListener("pointermove", (event) => {
      const box = area.getBoundingClientRect();
      read((event.clientX - box.left) / box.width);
    });
    area.addEventListener("pointerdown", (event) => {
      const box = area.getBoundingClientRect();
      read((event.clientX - box.left) / box.width);
    });
    plot.addEventListener("keydown", (event) => {
      const step = {ArrowLeft: -0.005, ArrowRight: 0.005, PageUp: -0.1, PageDown: 0.1}[event.key];
      if (step === undefined || event.target !== plot) return;
      event.preventDefault();
      read((share ?? 0.5) + step);
    });
  }

  const view = document.querySelector(".view");
  if (view) {
    const map = view.querySelector(".map");
    let zoom = 1;
    for (const button of document.querySelectorAll("[data-zoom]")) {
      button.addEventListener("click", () => {
        const factor = +button.dataset.zoom;
        const middle = [(view.scrollLeft + view.clientWidth / 2) / map.clientWidth, (view.scrollTop + view.clientHeight / 2) / map.clientHeight];
        zoom = factor ? Math.max(1, Math.min(32, zoom * factor)) : 1;
        map.style.setProperty("--zoom", zoom);
        view.scrollTo(middle[0] * map.clientWidth - view.clientWidth / 2, middle[1] * map.clientHeight - view.clientHeight / 2);
      });
    }
  }

  document.documentElement.dataset.drawn = plots.length;
}
