// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
// The page of a drive, from the numbers that it holds.
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const {figures, path, truth} = data;
const radars = Object.keys(data.radars).length ? Object.keys(data.radars)
  : Object.keys(data.statuses).filter((name) => name !== "odometry" && name !== "fused");
const hueOf = hues(radars);
const charts = new TimeCharts((time) => setTime(time));
const DOUBT_COLOR = MOVING, NO_DOUBT = inScheme("#e6f2ea", "#1f3a2b");
let now = 0;
const hasTargets = data.scans.some(({targets}) => targets.length);
const hasInnovations = Object.values(data.radars).some((series) => Object.entries(series).some(
  ([name, values]) => name.includes("nis_") && values.some((value) => value !== null)));

const hueOfSource = (source) => hueOf[source] ?? (source === "fused" ? MUTED : INK);

/** Index of the last that is not after `time`, 0 at least. */
function indexAt(times, time) {
  let low = 0, high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle; else high = middle;
  }
  return low;
}

function showAbout() {
  const begin = figures.begin_utime
    ? `${new Date(figures.begin_utime / 1000).toISOString().replace("T", " ").slice(0, 19)} UTC, ` : "";
  byId("about").textContent = `${begin}${radars.length} ${radars.length === 1 ? "radar" : "radars"}; made by ${data.version}`;
}

/** A text with commands in `backquotes`. */
function addText(parent, text) {
  text.split("`").forEach((part, i) => element(parent, i % 2 ? "code" : "span", part));
}

const MOODS = {error: "bad", warning: "careful", note: "muted"};

function showFindings() {
  if (!data.findings.length) element(byId("findings"), "li", "Nothing is wrong.", {className: "good"});
  for (const {severity, what, remedy} of data.findings) {
    const item = element(byId("findings"), "li", "", {className: MOODS[severity]});
    element(item, "b", `${severity}: `).className = MOODS[severity];
    addText(item, what);
    if (remedy) {
      element(item, "br");
      addText(item, `Remedy: ${remedy}`);
    }
  }
}

function showTiles() {
  addTile("duration", fixed(figures.duration_s, 1, " s"));
  if (figures.odometry) {
    addTile("path length", fixed(figures.path_length_m, 0, " m"));
    addTile("maximum speed", fixed(figures.maximum_speed_mps, 1, " m/s"));
    addTile("of the time with usable odometry", fixed(figures.odometry.availability_percent, 1, " %"));
  } else {
    addTile("odometry", "none");
  }
  const doubted = radars.filter((radar) => figures.radars[radar]?.statuses_in_doubt);
  if (!data.mounts_unknown && hasInnovations) addTile("radars in doubt at some time", doubted.join(", ") || "none");
  const odometry = truth?.figures.find(({source}) => source === "odometry");
  const late = odometry?.segments.find(({after}) => after === "10 s");
  if (late?.segments) addTile("position error after 10 s, of the path", fixed(late.position_percent, 2, " %"));
  if (odometry) addTile("ANEES of the odometry", fixed(odometry.anees, 2));
}

// ---- What depends on the slider's time ------------------------------------------------------------

/** No line where a part begins anew. */
function drawParts(plane, {x, y, begins}, color, width) {
  const ends = [...begins, x.length];
  [0, ...begins].forEach((begin, i) => plane.line(x.slice(begin, ends[i]), y.slice(begin, ends[i]), color, width));
}

function drawMap(plane) {
  if (truth) drawParts(plane, truth.path, TRUTH, 6);
  drawParts(plane, path, INK, 1.6);
  if (!path.t.length) return;
  const i = indexAt(path.t, now);
  const pose = {x: path.x[i], y: path.y[i], yaw: path.yaw[i]};
  plane.ellipse(pose, [path.cov_xx[i], path.cov_xy[i], path.cov_yy[i]], HUES[0]);
  plane.vehicle(pose, INK);
  byId("pose").textContent = `x ${fixed(pose.x, 2, " m")}, y ${fixed(pose.y, 2, " m")}, yaw ` +
    `${fixed(degrees(pose.yaw), 1, "°")}; sigma ${fixed(Math.sqrt(path.cov_xx[i]), 3)} and ` +
    `${fixed(Math.sqrt(path.cov_yy[i]), 3, " m")}; ${fixed(path.vx[i], 2, " m/s")}`;
}

const scansOf = Object.fromEntries(radars.map((radar) => {
  const scans = data.scans.filter(({source}) => source === radar);
  return [radar, {scans, times: scans.map(({t}) => t)}];
}));

function scansNow() {
  return radars.map((radar) => scansOf[radar])
    .filter(({times}) => times.length && times[0] <= now + 0.05)
    .map(({scans, times}) => scans[indexAt(times, now + 0.001)]);
}

function drawScansNow(plane) {
  const scans = scansNow();
  drawScans(plane, scans, hueOf,
            scans.map(({source, t}) => ({text: `${source} ${t.toFixed(2)} s`, color: hueOf[source]})));
}

const map = new Plane(byId("map"), drawMap);
const around = new Plane(byId("scans"), drawScansNow, {forwardUp: true});

function showPlanes() {
  fillLegend(byId("map-legend"), [
    ...MAP_LEGEND, ...(truth ? [{text: "truth, aligned at the start", color: TRUTH, mark: "━"}] : [])]);
  map.fit(boxOf(truth ? [path, truth.path] : [path]));
  const every = Math.ceil(data.scans.length / 200);
  const far = data.scans.filter((_, i) => i % every === 0).flatMap((scan) => [...targetsOf(scan)])
    .filter(({role}) => role === "used").map(({x, y}) => Math.max(Math.abs(x), Math.abs(y)))
    .sort((a, b) => a - b);
  const reach = Math.max(20, far[Math.floor(0.9 * far.length)] ?? 20);
  around.fit([-reach, -reach, reach, reach]);
  const means = data.mounts_unknown ? "Mounts are not known: each radar is drawn in its own frame." : OUTLIER_MEANS;
  byId("scans-note").textContent = data.scans.length ? means + keptScans()
    : "The log has no scans: set output.publish_scans = true.";
}

/** Of a long drive not every scan is in the file. */
function keptScans() {
  const kept = Math.max(...Object.values(scansOf).map(({times}) => times.length));
  const period = figures.duration_s / kept;
  return period > 0.5 ? ` For a drive of this length the file holds one scan of each radar per ${fixed(period, 1)} s.` : "";
}

function setTime(time) {
  now = Math.min(Math.max(time, 0), figures.duration_s);
  byId("time").value = now;
  byId("time-text").textContent = `${now.toFixed(2)} s`;
  map.redraw();
  around.redraw();
  charts.showTime(now);
}

/** #t=12.3 in the address. */
function timeOfAddress() {
  return Number(/[#&]t=([0-9.]+)/.exec(location.hash)?.[1] ?? 0);
}

function followSlider() {
  byId("time").max = figures.duration_s;
  byId("time").addEventListener("input", (event) => setTime(Number(event.target.value)));
  byId("time").addEventListener(
    "change", () => history.replaceState(null, "", `#t=${now.toFixed(2)}`));
  window.addEventListener("hashchange", () => setTime(timeOfAddress()));
  window.addEventListener("resize", () => setTime(now));
}

// ---- Curves ---------------------------------------------------------------------------------------

function showMotion() {
  const {vx, yaw_rate: yawRate} = data.rates;
  charts.add(byId("speed"), "speed [m/s]", [{name: "speed", color: HUES[0], ...vx}]);
  charts.add(byId("yaw-rate"), "yaw rate [°/s]", [{name: "yaw rate", color: HUES[1], ...yawRate}],
             {xlabel: "time [s]"});
}

function addForRadars(parent, ylabel, name, options = {}) {
  if (!radars.some((radar) => data.radars[radar]?.[name].some((value) => value !== null))) return;
  const div = element(element(byId(parent), "div"), "div", "", {className: "chart"});
  charts.add(div, ylabel, radars.filter((radar) => data.radars[radar]).map((radar) => {
    const series = data.radars[radar];
    return {name: radar, color: hueOf[radar], t: series.t, value: series[name],
            sigma: series[`${name}_sigma`]};
  }), options);
}

/** So that a radar of which little is known does not hide the others. */
function rangeOfLearned(name) {
  const all = radars.flatMap((radar) => data.radars[radar]?.[name] ?? []);
  const sigmas = radars.flatMap((radar) => data.radars[radar]?.[`${name}_sigma`] ?? []);
  const typical = sigmas.sort((a, b) => a - b)[sigmas.length >> 1] ?? 0;
  const most = Math.max(...all.map(Math.abs), 0) + 4 * typical;
  return most > 0 ? {valueRange: [-most, most]} : {};
}

function addLearned(ylabel, name) {
  addForRadars("learned", ylabel, name, {xlabel: "time [s]", ...rangeOfLearned(name)});
}

function showRadars() {
  const log = {logscale: true, valueRange: [0.03, 30]};
  if (figures.odometry) {
    addForRadars("innovations", "state: Doppler", "odometry_nis_doppler", log);
    addForRadars("innovations", "state: sideways", "odometry_nis_lateral", log);
    addForRadars("innovations", "state: yaw", "odometry_nis_yaw", log);
  }
  addForRadars("innovations", "positions/Doppler", "nis_doppler", {...log, marks: [3]});
  addForRadars("innovations", "motion/the next", "nis_next",
               {...log, marks: [3], xlabel: "time [s]"});
  if (figures.odometry) {
    addLearned("mount yaw error [°]", "mount_yaw_deg");
    addLearned("Doppler scale error [%]", "doppler_scale_percent");
  }
  fillLegend(byId("radars-legend"), radars.map((text) => ({text, color: hueOf[text], mark: "━"})));
}

// ---- Strips ---------------------------------------------------------------------------------------

function showStrips(id, rows, colorOf, legend) {
  const canvas = byId(id);
  canvas.style.height = `${20 * Object.keys(rows).length}px`;
  const draw = () => drawTimeline(canvas, rows, figures.duration_s, colorOf, charts.axis(), now);
  charts.followers.push(draw);
  fillLegend(byId(`${id}-legend`), legend);
}

function showStatuses() {
  const sources = ["odometry", "fused", ...radars].filter((source) => data.statuses[source]);
  const rows = Object.fromEntries(sources.map((source) => [source, data.statuses[source]]));
  const there = new Set(Object.values(rows).flat().map(([, status]) => status));
  const colorOf = (status) => STATUS_COLORS[status] ?? OUTLIER;
  showStrips("statuses", rows, colorOf, [...there].map(
    (status) => ({text: status.replaceAll("_", " "), color: colorOf(status)})));
  const doubts = new Set(Object.values(data.doubts).flat().map(([, doubt]) => doubt).filter(Boolean));
  showStrips("doubts", data.doubts, (doubt) => (doubt ? DOUBT_COLOR : NO_DOUBT), [
    {text: "no doubt", color: NO_DOUBT}, ...(doubts.size ? [{text: "doubt:", color: DOUBT_COLOR}] : []),
    ...[...doubts].map((doubt) => ({text: doubt.replaceAll("_", " "), color: DOUBT_COLOR, mark: "–"}))]);
}

// ---- Truth ----------------------------------------------------------------------------------------

/** A car's motion from scan to scan has no y of its own. */
function hasY(source) {
  return truth.figures.find((one) => one.source === source).degrees_of_freedom === 3;
}

function showTruthTable() {
  const head = ["source", "estimates", "RMSE [mm]", "RMSE [°]", "ANEES", "x in 3 sigma", "y", "yaw",
                "drift [%]", "[°/m]"];
  fillTable(byId("truth-table"), head, truth.figures.map((one) => [
    one.source, one.n, fixed(1000 * one.rmse_m, 1), fixed(one.rmse_deg, 3), fixed(one.anees, 2),
    ...["x", "y", "yaw"].map((axis) => (axis === "y" && !hasY(one.source) ? "–"
      : fixed(100 * one[`coverage_${axis}`][2], 1, " %"))),
    fixed(one.mean_drift.translation_percent, 2), fixed(one.mean_drift.rotation_deg_per_m, 4)]));
}

function segmentRows(source) {
  const {segments} = truth.figures.find((one) => one.source === source);
  return segments.filter((one) => one.segments).map((one) => [
    one.after, one.segments, fixed(one.position_percent, 2), fixed(one.rmse_m_m_rad[2] * 180 / Math.PI, 2),
    fixed(one.anees, 2)]);
}

function replaceChart(id, ylabel, series, options) {
  const old = charts.charts.findIndex((chart) => chart.maindiv_ === byId(id));
  if (old >= 0) charts.charts.splice(old, 1)[0].destroy();
  return charts.add(byId(id), ylabel, series, options);
}

/** Errors as dots in the band that their sigma makes about 0. */
function showErrors(id, ylabel, errors, value, sigma, color, options) {
  replaceChart(id, ylabel, [
    {name: "3 sigma", color: LEFT_OUT, t: errors.t, value: errors[sigma].map(() => 0),
     sigma: errors[sigma]},
    {name: "error", color, t: errors.t, value: errors[value]}],
  {series: {error: {strokeWidth: 0, drawPoints: true}}, fillAlpha: 0.35, ...options});
}

function showNees(errors, color) {
  const half = errors.mean_high.map((high, i) => (high - errors.mean_low[i]) / 6);
  const middle = errors.mean_high.map((high, i) => (high + errors.mean_low[i]) / 2);
  replaceChart("nees", "NEES", [
    {name: "NEES", color, t: errors.t, value: errors.nees},
    {name: "95 % of means", color: HUES[1], t: errors.t, value: middle, sigma: half},
    {name: "mean over 2 s", color: INK, t: errors.t, value: errors.mean_nees}],
  {series: {NEES: {strokeWidth: 0, drawPoints: true}, "95 % of means": {strokeWidth: 0}}, logscale: true,
   valueRange: [0.01, 100], marks: [1], xlabel: "time [s]"});
}

function showTruthOf(source) {
  const errors = truth.errors[source], color = hueOfSource(source);
  if (errors) {
    showErrors("error-x", "error of x [m]", errors, "x_m", "sigma_x_m", color);
    byId("error-y").hidden = !hasY(source);
    if (hasY(source)) showErrors("error-y", "error of y [m]", errors, "y_m", "sigma_y_m", color);
    showErrors("error-yaw", "error of yaw [°]", errors, "yaw_deg", "sigma_yaw_deg", color,
               {xlabel: "time [s]"});
    showNees(errors, color);
  }
  fillTable(byId("segments"), ["pose after", "windows", "error [% of the path]", "yaw [°]", "ANEES"],
            segmentRows(source));
  charts.showTime(now);
}

function showTruth() {
  const place = ({source}) => ["odometry", "fused", ...radars].indexOf(source);
  truth.figures.sort((a, b) => place(a) - place(b));
  byId("truth").hidden = false;
  byId("truth-std").textContent = truth.truth_std.length
    ? `Sigma of truth: ${truth.truth_std.join("; ")} (M,RAD,SECONDS), included in ANEES.`
    : "Truth is taken as exact.";
  showTruthTable();
  const names = truth.figures.map(({source}) => source), select = byId("truth-source");
  names.forEach((name) => element(select, "option", name));
  select.addEventListener("change", () => showTruthOf(select.value));
  charts.add(byId("drift"), "drift [%]", names.filter((name) => truth.drift[name]).map((name) => ({
    name, color: hueOfSource(name), t: truth.drift[name].length_m,
    value: truth.drift[name].translation_percent})),
  {isTime: false, xlabel: "length of the true path [m]", drawPoints: true, includeZero: true});
  fillLegend(byId("drift-legend"),
             names.map((text) => ({text, color: hueOfSource(text), mark: "━"})));
  showTruthOf(names[0]);
}

// ---- Tables ---------------------------------------------------------------------------------------

function showCounters() {
  const names = Object.keys(figures.radars[radars[0]]?.counters ?? {});
  const value = (radar, name) => figures.radars[radar].counters[name];
  const told = names.filter((name) => radars.some((radar) => value(radar, name)));
  const motions = [...new Set(Object.values(figures.sources).flatMap(({statuses}) => Object.keys(statuses)))];
  fillTable(byId("counters"), ["", ...radars], [
    ...told.map((name) => [name.replaceAll("_", " "), ...radars.map((radar) => value(radar, name))]),
    ...motions.map((status) => [`motions: ${status.replaceAll("_", " ")}`,
                                ...radars.map((radar) => figures.sources[radar]?.statuses[status] ?? 0)]),
    ["excluded from the odometry, by cause: statuses", ...radars.map((radar) => {
      const {statuses_left_out: causes, statuses} = figures.radars[radar];
      return Object.entries(causes).map(([cause, count]) => `${cause.replaceAll("_", " ")}: ${count} of ${statuses}`)
        .join(", ") || "never";
    })],
    ["faults that the radar reports", ...radars.map((radar) => figures.radars[radar].faults.join(", ") || "none")]]);
  byId("counters-note").textContent = `0 for all radars: ${
    names.filter((name) => !told.includes(name)).map((name) => name.replaceAll("_", " ")).join(", ")}.`;
}

function showWarnings() {
  byId("warnings").hidden = data.warnings.length === 0;
  byId("warnings-text").textContent = data.warnings.join("\n");
}

function hide(parts) {
  document.querySelectorAll(parts).forEach((part) => { part.hidden = true; });
}

showAbout();
showFindings();
showTiles();
if (figures.odometry) showMotion(); else hide(".of-odometry");
if (!figures.odometry) byId("statuses-title").textContent = "Status of the motion from scan to scan of each source";
if (!hasTargets && !figures.odometry) hide(".of-scans");
if (!hasInnovations) hide(".of-innovations");
if (data.mounts_unknown) hide(".of-mounts");
if (Object.keys(data.statuses).length) showStatuses(); else hide(".of-motions");
if (truth) showTruth();
showRadars();
if (figures.radars[radars[0]]) showCounters(); else hide(".of-counters");
showWarnings();
showPlanes();
followSlider();
setTime(timeOfAddress());
