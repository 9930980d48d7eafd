// Draws every chart from the data beside it, fitted to the screen and to the finger.
"use strict";
{
  const charts = [...document.querySelectorAll(".chart")];
  const touch = matchMedia("(pointer: coarse)").matches;
  const digits = (value) => {
    const decimals = Math.abs(value) < 1000 ? 3 : 2;
    return value.toLocaleString("en", {minimumFractionDigits: decimals, maximumFractionDigits: decimals});
  };

  // Lines from minimum to maximum of each bin: both belong into the hover text of either.
  const nameRanges = (trace) => {
    if (trace.meta !== "pairs") return;
    trace.text = [];
    for (let i = 0; i < trace.y.length; i += 2) {
      if (trace.y[i] === null) trace.text[i++] = "";
      const low = Math.min(trace.y[i], trace.y[i + 1]), high = Math.max(trace.y[i], trace.y[i + 1]);
      trace.text[i] = trace.text[i + 1] = digits(low) + " to " + digits(high);
    }
    trace.hovertemplate = "%{text} nT";
  };

  const draw = (chart) => {
    const {data, layout, config} = JSON.parse(document.getElementById(chart.id + "-data").textContent);
    data.forEach(nameRanges);
    if (touch) layout.dragmode = false; // a finger on a chart scrolls the page; the buttons zoom
    if (chart.clientWidth < 600) { // the names below, where they do not meet the buttons
      Object.assign(layout.legend, {y: -56 / (chart.clientHeight - 140), yanchor: "top"});
      Object.assign(layout.margin, {l: 48, r: 6, b: 40});
      layout.font.size = 12;
    }
    return Plotly.newPlot(chart, data, layout, config);
  };

  Promise.all(charts.map(draw)).then(() => {
    document.documentElement.dataset.drawn = charts.length;
  });

  // Paper is narrower than most screens.
  const paper_width_px = 680;
  addEventListener("beforeprint", () => {
    for (const chart of charts) Plotly.relayout(chart, {width: Math.min(paper_width_px, chart.clientWidth)});
  });
  addEventListener("afterprint", () => {
    for (const chart of charts) Plotly.relayout(chart, {width: null, autosize: true});
  });
}
