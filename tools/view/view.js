// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
// The live page: asks for the state again and again, and draws it.
"use strict";

const PERIOD_MS = 250, SILENT_MS = 2000;
// status_t.DOUBT_*, from the lowest bit.
const DOUBTS = ["registration contradicts Doppler", "motions contradict each other",
                "other radars contradict", "covariance too large", "positions contradict speed",
                "stamps run ahead"];
const byId = (id) => document.getElementById(id);

let state = null, messages = -1, heardAt = 0;
const charts = new TimeCharts();
const rates = {};

const map = new Plane(byId("map"), (plane) => {
  if (!state?.pose) return;
  plane.line([...state.path.x, state.pose.x], [...state.path.y, state.pose.y], DARK, 1.6);
  plane.ellipse(state.pose, state.pose.covariance, HUES[0]);
  plane.vehicle(state.pose, DARK);
});
const around = new Plane(byId("scans"), (plane) => {
  if (!state) return;
  const hueOf = hues(state.radars.map(({name}) => name));
  const counts = drawScans(plane, state.scans, hueOf);
  fillLegend(byId("scans-legend"), [
    ...ROLES.map((role) => ({...role, text: `${role.text} ${counts[role.text.split(" (")[0]] ?? 0}`})),
    ...Object.entries(hueOf).map(([text, color]) => ({text, color}))]);
}, {forwardUp: true, names: ["x forward [m]", "y left [m]"]});

function fillTiles(tiles) {
  byId("tiles").replaceChildren();
  for (const [text, value] of tiles) {
    const made = element(byId("tiles"), "div", "", {className: "tile"});
    element(made, "b", value);
    element(made, "span", text);
  }
}

function showPose({pose, rates: {vx, yaw_rate: yawRate}}) {
  byId("status").textContent = pose.status.replaceAll("_", " ");
  byId("status").style.color = STATUS_COLORS[pose.status] ?? OUTLIER;
  const last = (values) => values[values.length - 1];
  const sigma = (variance) => Math.sqrt(Math.max(variance, 0));
  fillTiles([
    ["speed", fixed(last(vx), 2, " m/s")], ["yaw rate", fixed(last(yawRate), 1, " °/s")],
    ["x", fixed(pose.x, 1, " m")], ["y", fixed(pose.y, 1, " m")],
    ["yaw", fixed(degrees(pose.yaw), 1, "°")],
    ["sigma of x and y",
     `${fixed(sigma(pose.covariance[0]), 2)}, ${fixed(sigma(pose.covariance[2]), 2, " m")}`]]);
}

function showRates(id, ylabel, color, name, xlabel) {
  const series = [{name, color, t: state.rates.t, value: state.rates[name],
                   sigma: state.rates[`${name}_sigma`]}];
  rates[id] ??= charts.add(byId(id), ylabel, series, {xlabel, dateWindow: [-60, 0]});
  rates[id].updateOptions({file: joined(series)});
}

// status_t.CAUSE_*
const FAULTS = ["yes", "yes: scale of Doppler", "yes: sign of Doppler", "yes: upside down",
                "yes: yaw of the mount", "yes: place of the mount", "yes: late", "yes: exchanged with another"];

function named(doubts) {
  return DOUBTS.filter((_, bit) => doubts & (1 << bit)).join(", ") || "none";
}

function learned(value, sigma, unit) {
  return sigma > 0 ? `${fixed(value, 2)} ± ${fixed(sigma, 2, unit)}` : "–";
}

function latency({latency_p50_us: p50, latency_p99_us: p99, latency_max_us: max}) {
  return max > 0 ? [p50, p99, max].map((us) => fixed(us / 1000, 2)).join(" / ") : "–";
}

// A row each; what a status tells is "–" while there is none.
const nis = (key) => ({status}) => (status[key] ? fixed(status[key], 2) : "–");
const ROWS = [
  ["last motion", ({motion}) => (motion ?? "–").replaceAll("_", " ")],
  ["usable targets", ({targets}) => targets],
  ["scans (incomplete)", ({status}) => `${status.scans} (${status.scans_incomplete})`],
  ["doubts", ({status}) => named(status.doubts)],
  ["left out of the odometry", ({status}) => (status.left_out ? FAULTS[status.fault] ?? "yes" : "no")],
  ["NIS: Doppler against the state", nis("odometry_nis_doppler")],
  ["NIS: sideways motion against the state", nis("odometry_nis_lateral")],
  ["NIS: turn against the state", nis("odometry_nis_yaw")],
  ["NIS: positions against Doppler", nis("nis_doppler")],
  ["NIS: a motion against the next", nis("nis_next")],
  ["learned: yaw of the mount", ({status}) => learned(status.mount_yaw_deg, status.mount_yaw_sigma_deg, "°")],
  ["learned: Doppler scale error",
   ({status}) => learned(status.doppler_scale_percent, status.doppler_scale_sigma_percent, " %")],
  ["latency, 50 % / 99 % / maximum [ms]", ({status}) => latency(status)],
];

function showRadars(radars) {
  const cell = (radar, tell) => (radar.status || tell === ROWS[0][1] ? tell(radar) : "–");
  fillTable(byId("radars"), ["", ...radars.map(({name}) => name)],
            ROWS.map(([text, tell]) => [text, ...radars.map((radar) => cell(radar, tell))]));
}

function show() {
  byId("scans-note").textContent = state.scans.length ? OUTLIER_MEANS
    : "No scans: run cremed with --publish-scans, or output.publish_scans = true.";
  showRadars(state.radars);
  around.redraw();
  if (!state.pose) return;
  showPose(state);
  map.fit(boxOf([state.path, {x: [state.pose.x], y: [state.pose.y]}]));
  showRates("speed", "speed [m/s]", HUES[0], "vx", "");
  showRates("yaw-rate", "yaw rate [°/s]", HUES[1], "yaw_rate", "seconds ago");
}

function showAge() {
  const silent = Date.now() - heardAt;
  byId("about").textContent = !state?.messages ? "no message from cremed yet"
    : silent < SILENT_MS ? `live, ${new Date(state.pose ? state.pose.utime / 1000 : heardAt).toISOString()}`
      : `silent for ${(silent / 1000).toFixed(0)} s`;
  byId("about").className = state?.messages && silent < SILENT_MS ? "muted" : "bad";
}

async function ask() {
  try {
    state = await (await fetch("state.json")).json();
    if (state.messages !== messages) {
      messages = state.messages;
      heardAt = Date.now();
      show();
    }
    showAge();
  } catch (error) {
    byId("about").textContent = `cremed-view does not answer: ${error.message}`;
    byId("about").className = "bad";
  }
  setTimeout(ask, PERIOD_MS);
}

fillLegend(byId("map-legend"), [{text: "odometry", color: DARK, mark: "━"},
                                {text: "95 % ellipse of the position", color: HUES[0], mark: "◯"}]);
around.fit([-80, -80, 80, 80]);
ask();
