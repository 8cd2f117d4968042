// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
// What cremed-report and cremed-view draw with; curves over time are dygraphs'.
"use strict";

// As the reader's system asks for; a change reloads the page.
const SCHEME = matchMedia("(prefers-color-scheme: dark)");
SCHEME.addEventListener("change", () => location.reload());
const inScheme = (light, dark) => (SCHEME.matches ? dark : light);

// One hue a radar, in the order of the configuration. Orange and red are kept for what moves and
// what contradicts.
const HUES = inScheme(
  ["#0072b2", "#009e73", "#aa4499", "#3fa7dd", "#8c6d31", "#332288", "#77b300", "#7f7f7f"],
  ["#4a9fe0", "#2fc297", "#d778c8", "#8fd3f7", "#c9a561", "#a396ff", "#a6d93b", "#b0b0b0"]);
const INK = inScheme("#1c2733", "#e4ebf2"), GRID = inScheme("#e3e8ed", "#2c3742");
const MUTED = inScheme("#5f6b78", "#9aa7b4"), LEFT_OUT = inScheme("#b9c2cb", "#56626e");
const MOVING = inScheme("#e07b00", "#f59b33"), OUTLIER = inScheme("#d0021b", "#ff5c6c");
const PLATE = inScheme("#ffffffcc", "#171e25cc"), TRUTH = inScheme("#9aa5b1", "#6f7c89");
// Each its own: green is good, grey a start, yellow an estimate without measurement, red lost.
const STATUS_COLORS = {
  ok: "#3a9d5d", standing_still: "#9bd3ae", no_reference: "#cdd6de", initialising: "#8fa3b5",
  predicted: "#f2cf63", gap_too_long: "#b9a27c", incomplete_scan: "#5f7f95",
  too_few_targets: "#c9a0dc", ambiguous: "#e07b00", degenerate: "#8e5bb0", no_convergence: "#4b2a7b",
  silent: "#e3e3e3", implausible: "#a23b5c", non_finite: "#4a0d18", lost: "#d0021b",
};
const NINETY_FIVE_PERCENT = 5.991;  // Of chi-square with two degrees of freedom.
const USABLE = 0, FLAGGED_MOVING = 3;  // radar_scan_t.DETECTION_*

const OUTLIER_MEANS =
  "Outlier: its Doppler differs by more than 3 sigma from that of a stationary target, given the odometry.";

const byId = (id) => document.getElementById(id);

/** From -180 to 180. */
function degrees(radians) {
  return Math.atan2(Math.sin(radians), Math.cos(radians)) * 180 / Math.PI;
}

function hues(radars) {
  return Object.fromEntries(radars.map((radar, i) => [radar, HUES[i % HUES.length]]));
}

function element(parent, tag, text = "", properties = {}) {
  const made = document.createElement(tag);
  made.textContent = text;
  Object.assign(made, properties);
  parent.append(made);
  return made;
}

/** A table: the head, and rows of cells. */
function fillTable(table, head, rows) {
  table.replaceChildren();
  const headRow = element(element(table, "thead"), "tr");
  head.forEach((text) => element(headRow, "th", text));
  const body = element(table, "tbody");
  for (const cells of rows) {
    const row = element(body, "tr");
    // On a narrow screen a cell has the name of its column beside it.
    cells.forEach((cell, i) => { element(row, "td", cell).dataset.label = head[i]; });
  }
}

/** [{text, color, mark}] below a picture. */
function fillLegend(parent, entries) {
  parent.replaceChildren();
  for (const {text, color, mark} of entries) {
    const entry = element(parent, "span");
    element(entry, "i", mark ?? "■").style.color = color;
    entry.append(` ${text}`);
  }
}

const MAP_LEGEND = [{text: "odometry", color: INK, mark: "━"},
                    {text: "95 % ellipse of the position", color: HUES[0], mark: "◯"}];

function addTile(text, value) {
  const made = element(byId("tiles"), "div", "", {className: "tile"});
  element(made, "b", value);
  element(made, "span", text);
}

function fixed(value, digits, unit = "") {
  return value === null || value === undefined ? "–" : value.toFixed(digits) + unit;
}

/** 1, 2 or 5 times a power of ten: the distance of ticks, some `wanted` of them in `span`. */
function tickStep(span, wanted) {
  const rough = span / wanted, power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
}

/** A canvas's context in pixels of the page, cleared. */
function cleared(canvas) {
  const {clientWidth: width, clientHeight: height} = canvas, ratio = window.devicePixelRatio || 1;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  context.font = "11px sans-serif";
  return {context, width, height};
}

/** A canvas in metres, equal on both axes. The wheel zooms, dragging moves, a double click shows all.
    With `forwardUp` the first coordinate goes up and the second to the left, as a driver sees it. */
class Plane {
  constructor(canvas, draw, {forwardUp = false} = {}) {
    const names = forwardUp ? ["x forward [m]", "y left [m]"] : ["x [m]", "y [m]"];
    Object.assign(this, {canvas, draw, forwardUp, names, box: [-1, -1, 1, 1], zoomed: null});
    canvas.addEventListener("wheel", (event) => this.onWheel(event), {passive: false});
    canvas.addEventListener("pointermove", (event) => this.onDrag(event));
    canvas.addEventListener("dblclick", () => this.show(null));
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  /** What to show while nobody has zoomed: [least x, least y, greatest x, greatest y]. */
  fit(box) {
    this.box = box;
    this.redraw();
  }

  show(zoomed) {
    this.zoomed = zoomed;
    this.redraw();
  }

  turned([x, y]) {
    return this.forwardUp ? [-y, x] : [x, y];
  }

  home({width, height}) {
    const corners = [this.turned(this.box.slice(0, 2)), this.turned(this.box.slice(2))];
    const spans = [0, 1].map((axis) => Math.abs(corners[1][axis] - corners[0][axis]) || 1);
    return {scale: 0.9 * Math.min((width - 60) / spans[0], (height - 40) / spans[1]),
            middle: [0, 1].map((axis) => (corners[0][axis] + corners[1][axis]) / 2)};
  }

  pixel(x, y) {
    const [right, up] = this.turned([x, y]), {scale, middle} = this.at;
    return [this.area.width / 2 + 20 + scale * (right - middle[0]),
            this.area.height / 2 - 12 - scale * (up - middle[1])];
  }

  redraw() {
    if (!this.canvas.clientWidth) return;
    this.area = cleared(this.canvas);
    this.context = this.area.context;
    this.at = this.zoomed ?? this.home(this.area);
    this.labels = [];
    this.grid();
    this.draw(this);
    this.labels.forEach((label) => this.write(label));
  }

  /** Above what is drawn, on a plate of its own. */
  write({text, x, y, align}) {
    const {context} = this, width = context.measureText(text).width;
    const left = align === "center" ? x - width / 2 : align === "right" ? x - width : x;
    context.fillStyle = PLATE;
    context.fillRect(left - 2, y - 10, width + 4, 13);
    Object.assign(context, {fillStyle: MUTED, textAlign: "left"});
    context.fillText(text, left, y);
  }

  grid() {
    const {context, area: {width, height}, at: {scale, middle}} = this;
    const step = tickStep(Math.min(width, height) / scale, 5);
    context.strokeStyle = GRID;
    for (const axis of [0, 1]) {
      const half = (axis === 0 ? width : height) / scale / 2 + step;
      for (let k = Math.ceil((middle[axis] - half) / step); k * step < middle[axis] + half; ++k) {
        this.gridLine(axis, k * step, step);
      }
    }
    this.labels.push({text: this.names[this.forwardUp ? 1 : 0], x: width - 6, y: height - 4, align: "right"},
                     {text: this.names[this.forwardUp ? 0 : 1], x: 4, y: 12, align: "left"});
  }

  gridLine(axis, value, step) {
    const {context, area: {width, height}, at: {scale, middle}} = this;
    const text = String(+(this.forwardUp && axis === 0 ? -value : value).toPrecision(6));
    context.beginPath();
    if (axis === 0) {
      const x = width / 2 + 20 + scale * (value - middle[0]);
      context.moveTo(x, 0);
      context.lineTo(x, height);
      if (x > 40 && x < width - 70) this.labels.push({text, x, y: height - 4, align: "center"});
    } else {
      const y = height / 2 - 12 - scale * (value - middle[1]);
      context.moveTo(0, y);
      context.lineTo(width, y);
      if (y > 34 && y < height - 28) this.labels.push({text, x: 4, y: y + 4, align: "left"});
    }
    context.stroke();
  }

  onWheel(event) {
    event.preventDefault();
    const {scale, middle} = this.at, factor = Math.exp(-0.002 * event.deltaY);
    const from = [event.offsetX - this.area.width / 2 - 20, this.area.height / 2 - 12 - event.offsetY];
    this.show({scale: scale * factor,
               middle: middle.map((value, axis) => value + from[axis] / scale * (1 - 1 / factor))});
  }

  onDrag(event) {
    if (event.buttons !== 1 || event.pointerType !== "mouse") return;
    const {scale, middle} = this.at;
    this.show({scale, middle: [middle[0] - event.movementX / scale,
                               middle[1] + event.movementY / scale]});
  }

  line(x, y, color, width) {
    const {context} = this;
    context.beginPath();
    x.forEach((value, i) => context.lineTo(...this.pixel(value, y[i])));
    Object.assign(context, {strokeStyle: color, lineWidth: width, lineJoin: "round"});
    context.stroke();
    context.lineWidth = 1;
  }

  /** The vehicle, its nose ahead, not smaller than can be seen. */
  vehicle({x, y, yaw}, color) {
    const {context} = this, long = Math.max(4.4, 16 / this.at.scale), wide = 0.42 * long;
    const corners = [[-0.25, 0.5], [0.6, 0.5], [0.75, 0], [0.6, -0.5], [-0.25, -0.5]];
    context.beginPath();
    for (const [ahead, left] of corners) {
      const [dx, dy] = [ahead * long, left * wide];
      context.lineTo(...this.pixel(x + dx * Math.cos(yaw) - dy * Math.sin(yaw),
                                   y + dx * Math.sin(yaw) + dy * Math.cos(yaw)));
    }
    context.closePath();
    Object.assign(context, {fillStyle: `${color}33`, strokeStyle: color});
    context.fill();
    context.stroke();
  }

  /** Where the pose is with 95 %: its covariance is [xx, xy, yy]. */
  ellipse({x, y}, [xx, xy, yy], color) {
    const {context} = this, half = (xx - yy) / 2, root = Math.hypot(half, xy);
    const axes = [1, -1].map((sign) => Math.sqrt(
      NINETY_FIVE_PERCENT * Math.max((xx + yy) / 2 + sign * root, 0)));
    const angle = Math.atan2(xy, half) / 2;
    context.beginPath();
    context.ellipse(...this.pixel(x, y), this.at.scale * axes[0], this.at.scale * axes[1], -angle, 0,
                    2 * Math.PI);
    Object.assign(context, {fillStyle: `${color}22`, strokeStyle: color});
    context.fill();
    context.stroke();
  }
}

function boxOf(paths, least = 10) {
  const x = paths.flatMap((path) => path.x), y = paths.flatMap((path) => path.y);
  if (!x.length) return [-least, -least, least, least];
  const reduce = (values, pick) => values.reduce((a, b) => pick(a, b));
  const box = [reduce(x, Math.min), reduce(y, Math.min), reduce(x, Math.max), reduce(y, Math.max)];
  const wider = Math.max(0, least - Math.max(box[2] - box[0], box[3] - box[1])) / 2;
  return [box[0] - wider, box[1] - wider, box[2] + wider, box[3] + wider];
}

/** The targets of a scan {mount, targets, twist} in the vehicle frame. Of each five numbers: range in
    cm, azimuth in 0.1 mrad, Doppler and its sigma in cm/s, validity. Moving: flagged by the radar.
    Outlier: its Doppler differs by more than 3 sigma from that of a stationary target, given the
    odometry's velocity. */
function* targetsOf({mount: [mountX, mountY, mountYaw], targets, twist}) {
  for (let i = 0; i < targets.length; i += 5) {
    const range = targets[i] / 100, angle = targets[i + 1] / 1e4 + mountYaw;
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    let role = targets[i + 4] === USABLE ? "used" :
      targets[i + 4] === FLAGGED_MOVING ? "moving" : "left out";
    if (role === "used" && twist) {
      const [vx, vy, yawRate] = twist;
      const stationary = -((vx - yawRate * mountY) * cos + (vy + yawRate * mountX) * sin);
      if (Math.abs(targets[i + 2] / 100 - stationary) > 3 * targets[i + 3] / 100) role = "outlier";
    }
    yield {x: mountX + range * cos, y: mountY + range * sin, role};
  }
}

const ROLES = [{text: "used (hue of its radar)", color: MUTED, mark: "●"},
               {text: "moving", color: MOVING, mark: "▲"}, {text: "outlier", color: OUTLIER, mark: "✕"},
               {text: "left out", color: LEFT_OUT, mark: "●"}];

function drawTarget(context, x, y, role, hue) {
  context.fillStyle = {used: hue, moving: MOVING, outlier: OUTLIER, "left out": LEFT_OUT}[role];
  context.strokeStyle = context.fillStyle;
  context.beginPath();
  if (role === "moving") {
    [[0, -4], [4, 3.5], [-4, 3.5]].forEach(([dx, dy]) => context.lineTo(x + dx, y + dy));
    context.fill();
  } else if (role === "outlier") {
    for (const sign of [1, -1]) {
      context.moveTo(x - 3, y - 3 * sign);
      context.lineTo(x + 3, y + 3 * sign);
    }
    context.lineWidth = 1.6;
    context.stroke();
    context.lineWidth = 1;
  } else {
    context.arc(x, y, role === "used" ? 2.6 : 1.6, 0, 2 * Math.PI);
    context.fill();
  }
}

/** Scans around the vehicle; below, how many targets have each role, and more entries. */
function drawScans(plane, scans, hueOf, entries) {
  const counts = {};
  plane.vehicle({x: 0, y: 0, yaw: 0}, INK);
  for (const scan of scans) {
    for (const {x, y, role} of targetsOf(scan)) {
      drawTarget(plane.context, ...plane.pixel(x, y), role, hueOf[scan.source]);
      counts[role] = (counts[role] ?? 0) + 1;
    }
    const [x, y] = plane.pixel(scan.mount[0], scan.mount[1]);
    plane.context.fillStyle = hueOf[scan.source];
    plane.context.fillRect(x - 3, y - 3, 6, 6);
  }
  fillLegend(byId("scans-legend"), [
    ...ROLES.map((role) => ({...role, text: `${role.text} ${counts[role.text.split(" (")[0]] ?? 0}`})), ...entries]);
}

/** Rows for dygraphs of series {t, value, sigma} that have times of their own; bands of 3 sigma. */
function joined(series) {
  const rows = new Map();
  series.forEach(({t, value, sigma}, column) => t.forEach((time, i) => {
    if (!rows.has(time)) rows.set(time, Array(series.length).fill(null));
    const band = sigma ? 3 * sigma[i] : 0;
    rows.get(time)[column] = value[i] === null ? [NaN, NaN, NaN] :
      [value[i] - band, value[i], value[i] + band];
  }));
  return [...rows.entries()].sort(([a], [b]) => a - b).map(([time, values]) => [time, ...values]);
}

/** Curves over time that zoom and move together, with a line at the time that is looked at. */
class TimeCharts {
  constructor(onPick = () => {}) {
    Object.assign(this, {onPick, charts: [], window: null, time: null, followers: []});
  }

  /** `series`: [{name, color, t, value, sigma}]; `marks`: values with a line of their own. */
  add(div, ylabel, series, {marks = [], xlabel = "", isTime = true, ...options} = {}) {
    const labels = ["time", ...series.map(({name}) => name)];
    const chart = new Dygraph(div, joined(series), {
      labels, ylabel, xlabel, customBars: true, connectSeparatedPoints: true, legend: "onmouseover",
      colors: series.map(({color}) => color), strokeWidth: 1.4,
      pointSize: 1.6, fillAlpha: 0.18, axisLabelFontSize: 11, gridLineColor: GRID,
      axisLineColor: LEFT_OUT, highlightCircleSize: 3, rightGap: 12,
      axes: {y: {axisLabelWidth: 52, pixelsPerLabel: 24}}, labelsSeparateLines: false, ...options,
      underlayCallback: (context, area, graph) => drawMarks(context, area, graph, marks),
      clickCallback: (event, x) => isTime && this.onPick(x),
      drawCallback: (graph, isInitial) => isTime && !isInitial && this.zoom(graph.xAxisRange(), graph),
    });
    if (isTime) {
      this.charts.push(chart);
      chart.cursor = element(div, "div", "", {className: "cursor"});
    }
    return chart;
  }

  zoom(window, from) {
    if (this.isZooming || String(window) === String(this.window)) return;
    this.window = window;
    this.isZooming = true;  // Each chart tells when it was drawn.
    this.charts.filter((chart) => chart !== from)
      .forEach((chart) => chart.updateOptions({dateWindow: window}));
    this.isZooming = false;
    this.showTime(this.time);
  }

  showTime(time) {
    this.time = time;
    for (const chart of this.charts) {
      const {x, y, w, h} = chart.getArea(), place = chart.toDomXCoord(time);
      Object.assign(chart.cursor.style, {
        left: `${place}px`, top: `${y}px`, height: `${h}px`,
        display: place >= x && place <= x + w ? "block" : "none"});
    }
    this.followers.forEach((follow) => follow());
  }

  /** Where time is on the page: left and width of the curves, the seconds there. Nothing without curves. */
  axis() {
    if (!this.charts.length) return null;
    const area = this.charts[0].getArea();
    return {left: area.x, width: area.w, window: this.charts[0].xAxisRange()};
  }
}

/** Dashed lines at values. */
function drawMarks(context, area, graph, marks) {
  context.strokeStyle = MUTED;
  context.setLineDash([4, 4]);
  for (const mark of marks) {
    const y = graph.toDomYCoord(mark);
    line(context, area.x, y, area.x + area.w, y);
  }
  context.setLineDash([]);
}

function line(context, x0, y0, x1, y1) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}

/** Strips of colour over time, in line with the curves: rows {name: [[time, text], ...]}. */
function drawTimeline(canvas, rows, end, colorOf, axis, time) {
  const {context, width: room} = cleared(canvas), step = 20;
  const {left, width, window: [begin, last]} = axis ?? {left: 80, width: room - 92, window: [0, end]};
  const place = (t) => left + width * (t - begin) / (last - begin);
  Object.entries(rows).forEach(([name, runs], row) => {
    context.fillStyle = MUTED;
    context.textAlign = "left";
    context.fillText(name.slice(0, 10), 2, row * step + 13);
    runs.forEach(([from, text], i) => {
      const x0 = Math.max(place(from), left);
      const x1 = Math.min(place(i + 1 < runs.length ? runs[i + 1][0] : end), left + width);
      context.fillStyle = colorOf(text);
      if (x1 > x0) context.fillRect(x0, row * step + 3, Math.max(x1 - x0, 1), step - 6);
    });
  });
  context.strokeStyle = OUTLIER;
  const x = place(time);
  if (x >= left && x <= left + width) line(context, x, 0, x, step * Object.keys(rows).length);
}
