// A page that failed must say so, and not stand there with empty charts.
"use strict";
{
  const report = (message) => {
    document.documentElement.dataset.errors = [document.documentElement.dataset.errors, message].filter(Boolean).join("; ");
    for (const chart of document.querySelectorAll(".chart:empty")) chart.textContent = "This chart could not be drawn: " + message;
  };
  addEventListener("error", (event) => report(event.message));
  addEventListener("unhandledrejection", (event) => report(String(event.reason)));
}
