"use strict";
// How times and numbers are written, and small helpers for the document.
const NO_VALUE = "–";
// What has begun before 1973 counts from its own start: no clock was set.
const isUtc = (s) => s > 1e8;
const two = (n) => String(n).padStart(2, "0");
function clock(s, withTenths) {
  if (s == null || !Number.isFinite(s)) return NO_VALUE;
  const tenths = Math.round(s * 10);
  const whole = Math.floor(tenths / 10);
  const day = isUtc(s) ? whole % 86400 : whole;
  const text = `${two(Math.floor(day / 3600))}:${two(Math.floor(day / 60) % 60)}:${two(day % 60)}`;
  return withTenths ? `${text}.${((tenths % 10) + 10) % 10}` : text;
}
function number(value, digits, withSign) {
  if (value == null || !Number.isFinite(value)) return NO_VALUE;
  const text = Math.abs(value).toLocaleString("en", { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: true });
  return `${value < 0 ? "−" : withSign ? "+" : ""}${text}`;
}
const degrees = (value, positive, negative) => `${Math.abs(value).toFixed(6)}° ${value < 0 ? negative : positive}`;
const at = (id) => document.getElementById(id);
function element(tag, text, className) {
  const made = document.createElement(tag);
  if (text != null) made.textContent = text;
  if (className) made.className = className;
  return made;
}
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
// What this screen was set to the last time; a browser may keep nothing.
const settings = {
  get(name, otherwise) {
    try { return JSON.parse(localStorage.getItem(`towmag ${name}`)) ?? otherwise; } catch { return otherwise; }
  },
  set(name, value) {
    try { localStorage.setItem(`towmag ${name}`, JSON.stringify(value)); } catch { /* It lasts as long as the page, then. */ }
  },
};
