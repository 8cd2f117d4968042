// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
// The live page: asks for the state again and again, and draws it.
"use strict";

const PERIOD_MS = 250, SILENT_S = 2;
// Clocks of two computers differ by less; what is older was measured in an earlier drive.
const REPLAY_S = 60;

let state = null, messages = -1;
const charts = new TimeCharts();
const rates = {};

const map = new Plane(byId("map"), (plane) => {
  if (!state?.pose) return;
  plane.line([...state.path.x, state.pose.x], [...state.path.y, state.pose.y], INK, 1.6);
  plane.ellipse(state.pose, state.pose.covariance, HUES[0]);
  plane.vehicle(state.pose, INK);
});
const around = new Plane(byId("scans"), (plane) => {
  if (!state) return;
  const hueOf = hues(state.radars.map(({name}) => name));
  drawScans(plane, state.scans, hueOf, Object.entries(hueOf).map(([text, color]) => ({text, color})));
}, {forwardUp: true});

function showPose({pose, rates: {vx, yaw_rate: yawRate}}) {
  const last = (values) => values[values.length - 1];
  const sigma = (variance) => Math.sqrt(Math.max(variance, 0));
  byId("tiles").replaceChildren();
  addTile("speed", fixed(last(vx), 2, " m/s"));
  addTile("yaw rate", fixed(last(yawRate), 1, " °/s"));
  addTile("x", fixed(pose.x, 1, " m"));
  addTile("y", fixed(pose.y, 1, " m"));
  addTile("yaw", fixed(degrees(pose.yaw), 1, "°"));
  addTile("sigma of x and y", `${fixed(sigma(pose.covariance[0]), 2)}, ${fixed(sigma(pose.covariance[2]), 2, " m")}`);
}

function showRates(id, ylabel, color, name, xlabel) {
  const series = [{name, color, t: state.rates.t, value: state.rates[name],
                   sigma: state.rates[`${name}_sigma`]}];
  rates[id] ??= charts.add(byId(id), ylabel, series, {xlabel, dateWindow: [-60, 0]});
  rates[id].updateOptions({file: joined(series)});
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
  ["scans per second", ({scan_rate_hz: rate, silent_s: silent}) =>
    (silent >= SILENT_S ? `silent for ${silent.toFixed(0)} s` : fixed(rate, 1))],
  ["usable targets", ({targets}) => targets],
  ["scans (incomplete)", ({status}) => `${status.scans} (${status.scans_incomplete})`],
  ["doubts", ({status}) => status.doubts.join(", ") || "none"],
  ["left out of the odometry", ({status}) => (status.left_out ? `yes: ${status.cause}` : "no")],
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
  const cell = (radar, tell) => (radar.status || ROWS.slice(0, 2).some((row) => row[1] === tell) ? tell(radar) : "–");
  fillTable(byId("radars"), ["", ...radars.map(({name}) => name)],
            ROWS.map(([text, tell]) => [text, ...radars.map((radar) => cell(radar, tell))]));
}

function show() {
  byId("scans-note").textContent = state.scans.length ? OUTLIER_MEANS
    : "No scans: run cremed with --publish-scans, or output.publish_scans = true.";
  around.redraw();
  if (!state.pose) return;
  showPose(state);
  map.fit(boxOf([state.path, {x: [state.pose.x], y: [state.pose.y]}]));
  showRates("speed", "speed [m/s]", HUES[0], "vx", "");
  showRates("yaw-rate", "yaw rate [°/s]", HUES[1], "yaw_rate", "seconds ago");
}

/** What is not told any more is not good, whatever it was. */
function showStatus({pose}) {
  const isSilent = pose && pose.silent_s >= SILENT_S;
  byId("status").textContent = isSilent ? "silent" : (pose?.status ?? "").replaceAll("_", " ");
  byId("status").style.color = isSilent ? OUTLIER : STATUS_COLORS[pose?.status] ?? OUTLIER;
}

function ageOf({messages: heard, silent_s: silent, pose, has_ended: hasEnded}) {
  if (!heard) return "no message from cremed yet";
  if (silent >= SILENT_S) return `silent for ${silent.toFixed(0)} s`;
  if (!pose) return "no odometry yet";
  if (pose.silent_s >= SILENT_S) return `no odometry for ${pose.silent_s.toFixed(0)} s, last ${pose.status.replaceAll("_", " ")}`;
  const kind = Math.abs(pose.behind_s) > REPLAY_S ? "replay of" : "live,";
  return `${kind} ${new Date(pose.utime / 1000).toISOString()}${hasEnded ? ", where the log ends" : ""}`;
}

function showAge() {
  const text = ageOf(state);
  byId("about").textContent = text;
  byId("about").className = /^(live|replay)/.test(text) ? "muted" : "bad";
  showStatus(state);
}

async function ask() {
  try {
    state = await (await fetch("state.json")).json();
    if (state.messages !== messages) {
      messages = state.messages;
      show();
    }
    showAge();
    showRadars(state.radars);
  } catch (error) {
    byId("about").textContent = `cremed-view does not answer: ${error.message}`;
    byId("about").className = "bad";
    byId("status").textContent = "";
  }
  setTimeout(ask, PERIOD_MS);
}

fillLegend(byId("map-legend"), MAP_LEGEND);
around.fit([-80, -80, 80, 80]);
ask();
