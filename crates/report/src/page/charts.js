// A cursor and zoom for the figures of this page. Each figure brings its axes and values along; without this script the
// pictures stand as they are.
"use strict";
(() => {
  const WIDTH = 960;
  const INK = "#1f2328", FRAME = "#6e7781", GRID = "#e3e6ea", MINOR_GRID = "#f3f4f6", MARK = "#0072b2", BAND = "#f0e442";
  const FONTS = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";
  // Movements of the pointer below this (pixels of the picture) are a click.
  const CLICK = 4;
  const FEWEST_LINES = 3;

  const charts = [];
  let zoomsTogether = () => false;

  const element = (name, attributes = {}, parent = null, text = null) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== null) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  };

  // Single precision, little-endian, in Base64.
  const floats = (text) => {
    const bytes = Uint8Array.from(atob(text), (digit) => digit.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Float32Array.from({ length: bytes.length / 4 }, (_, index) => view.getFloat32(4 * index, true));
  };

  const minus = (text) => text.replace(/-/g, "−");
  const raised = (power) => String(power).replace(/[-\d]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));
  const decade = (value) => Math.floor(Math.log10(Math.abs(value)) + 1e-9);

  // Four significant digits.
  const shown = (value) => {
    if (!Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const power = decade(value);
    if (power >= -3 && power < 6) return minus(value.toFixed(Math.max(0, 3 - power)));
    const [mantissa, exponent] = value.toExponential(3).split("e");
    return `${minus(mantissa)} × 10${raised(Number(exponent))}`;
  };

  // 1, 2 or 5 times a power of ten that is not below or not above `value`.
  const seriesAtLeast = (value) => {
    const power = 10 ** decade(value);
    return power * [1, 2, 5, 10].find((digit) => digit * power >= value * (1 - 1e-9));
  };
  const seriesAtMost = (value) => {
    const power = 10 ** decade(value);
    return power * [5, 2, 1].find((digit) => digit * power <= value * (1 + 1e-9));
  };

  const position = (axis, value) => {
    if (axis.scale === "logarithmic") {
      return value > 0 ? Math.log10(value / axis.low) / Math.log10(axis.high / axis.low) : NaN;
    }
    return (value - axis.low) / (axis.high - axis.low);
  };

  const ticks = (axis, most) => {
    if (axis.scale === "phase") {
      const label = (value) => ({ value, label: minus(String(value)) });
      return { major: [-180, -90, 0, 90, 180].map(label), minor: [-135, -45, 45, 135] };
    }
    return axis.scale === "logarithmic" ? logarithmicTicks(axis, most) : linearTicks(axis, most);
  };

  const linearTicks = ({ low, high }, most) => {
    const step = seriesAtLeast((high - low) / most);
    const parts = Math.round(step / 10 ** decade(step)) === 2 ? 4 : 5;
    const decimals = Math.max(0, -decade(step));
    const found = { major: [], minor: [] };
    for (let n = Math.ceil((low * parts) / step - 1e-9); n <= (high * parts) / step + 1e-9; n += 1) {
      const value = (n * step) / parts;
      if (n % parts === 0) found.major.push({ value, label: minus((value + 0).toFixed(decimals)) });
      else found.minor.push(value);
    }
    return found;
  };

  const logarithmicTicks = ({ low, high }, most) => {
    const decades = Math.log10(high / low);
    const stride = Math.max(1, Math.ceil(decades / most));
    const plain = decade(low) >= -3 && decade(high) <= 3;
    const found = { major: [], minor: [] };
    for (let power = decade(low); power <= decade(high); power += 1) {
      for (let digit = 1; digit <= 9; digit += 1) {
        const value = digit * 10 ** power;
        if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
        const labelled = decades < 1.5 ? [1, 2, 5].includes(digit) : digit === 1 && power % stride === 0;
        const label = plain ? String(Number(value.toPrecision(1))) : `${digit === 1 ? "" : `${digit}·`}10${raised(power)}`;
        if (labelled) found.major.push({ value, label });
        else found.minor.push(value);
      }
    }
    return found;
  };

  class Chart {
    constructor(figure) {
      this.figure = figure;
      this.data = JSON.parse(figure.querySelector("script").textContent);
      this.lines = floats(this.data.lines);
      for (const strip of this.data.strips) {
        for (const curve of strip.curves) curve.values = floats(curve.values);
      }
      this.whole = [this.data.frequency.low, this.data.frequency.high];
      this.range = this.whole;
      this.line = null;
      this.picture = figure.querySelector(".picture");
      this.still = this.picture.querySelector("svg");
      this.zoomed = null;
      this.overlay = element("svg", { viewBox: `0 0 ${WIDTH} ${this.data.height}`, class: "overlay", "aria-hidden": "true" }, this.picture);
      figure.tabIndex = 0;
      this.listen();
      this.control();
    }

    control() {
      const controls = document.createElement("div");
      controls.className = "controls";
      const named = [
        ["+", "Zoom in", () => this.zoomBy(0.5)],
        ["−", "Zoom out", () => this.zoomBy(2)],
        ["whole range", "Show the whole range", () => this.show(this.whole)],
      ];
      for (const [text, title, act] of named) {
        const button = document.createElement("button");
        Object.assign(button, { type: "button", textContent: text, title, onclick: act });
        controls.append(button);
      }
      this.figure.append(controls);
    }

    listen() {
      let start = null;
      const place = (event) => {
        const box = this.overlay.getBoundingClientRect();
        return ((event.clientX - box.left) / box.width) * WIDTH;
      };
      this.overlay.addEventListener("pointerdown", (event) => {
        if (event.button !== 0) return;
        start = place(event);
        try {
          this.overlay.setPointerCapture(event.pointerId);
        } catch {
          // The pointer has gone already.
        }
      });
      this.overlay.addEventListener("pointermove", (event) => {
        const x = place(event);
        this.pointAt(this.nearest(this.frequencyAt(x)));
        if (start !== null && Math.abs(x - start) > CLICK) this.select(start, x);
      });
      this.overlay.addEventListener("pointerup", (event) => {
        const x = place(event);
        if (start !== null && Math.abs(x - start) > CLICK) {
          this.show([this.frequencyAt(Math.min(start, x)), this.frequencyAt(Math.max(start, x))]);
        }
        start = null;
      });
      this.overlay.addEventListener("pointercancel", () => {
        start = null;
        this.pointAt(this.line);
      });
      this.overlay.addEventListener("pointerleave", () => {
        if (start === null) this.pointAt(null);
      });
      this.overlay.addEventListener("dblclick", () => this.show(this.whole));
      this.figure.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const step = event.shiftKey ? 10 : 1;
        const acts = {
          ArrowLeft: () => this.walk(-step),
          ArrowRight: () => this.walk(step),
          "+": () => this.zoomBy(0.5),
          "-": () => this.zoomBy(2),
          0: () => this.show(this.whole),
          Escape: () => this.show(this.whole),
        };
        const act = acts[event.key];
        if (act) {
          event.preventDefault();
          act();
        }
      });
    }

    frequencyAt(x) {
      const [low, high] = this.range;
      const share = Math.min(1, Math.max(0, (x - this.data.left) / this.data.width));
      return low + share * (high - low);
    }

    placeOf(hz) {
      const [low, high] = this.range;
      return this.data.left + (this.data.width * (hz - low)) / (high - low);
    }

    // Number of the first line that is not below `hz`.
    firstFrom(hz) {
      let [low, high] = [0, this.lines.length];
      while (low < high) {
        const middle = (low + high) >> 1;
        if (this.lines[middle] < hz) low = middle + 1;
        else high = middle;
      }
      return low;
    }

    nearest(hz) {
      const after = Math.min(this.firstFrom(hz), this.lines.length - 1);
      const before = Math.max(after - 1, 0);
      return hz - this.lines[before] < this.lines[after] - hz ? before : after;
    }

    walk(step) {
      const [low, high] = this.range;
      const from = this.line ?? this.nearest((low + high) / 2);
      const line = Math.min(this.lines.length - 1, Math.max(0, from + step));
      if (this.lines[line] >= low && this.lines[line] <= high) this.pointAt(line);
    }

    // Moves the cursor to a line, or takes it away.
    pointAt(line) {
      this.line = line;
      this.overlay.replaceChildren();
      const at = this.figure.querySelector("[data-frequency]");
      at.textContent = line === null ? "" : `${Number(this.lines[line].toPrecision(7))} Hz`;
      for (const reading of this.figure.querySelectorAll("[data-curve]")) {
        const strip = this.data.strips[reading.dataset.strip];
        const value = line === null ? null : strip.curves[reading.dataset.curve].values[line];
        const space = strip.unit.startsWith("10") ? " · " : " ";
        reading.textContent = value === null ? "" : `${shown(value)}${strip.unit ? space + strip.unit : ""}`;
      }
      const x = line === null ? NaN : this.placeOf(this.lines[line]);
      if (!(x >= this.data.left - 1e-6 && x <= this.data.left + this.data.width + 1e-6)) return;
      this.data.strips.forEach((strip, number) => {
        const [y1, y2] = [strip.top, strip.top + strip.height];
        element("line", { x1: x, x2: x, y1, y2, stroke: INK, "stroke-width": 1 }, this.overlay);
        const axis = this.axes()[number];
        for (const curve of strip.curves) {
          const up = axis ? position(axis, curve.values[line]) : NaN;
          if (!(up >= 0 && up <= 1)) continue;
          const dot = { cx: x, cy: y2 - up * strip.height, r: 3.2, fill: "#fff", stroke: curve.colour, "stroke-width": 2 };
          element("circle", dot, this.overlay);
        }
      });
    }

    select(from, to) {
      const inside = (x) => Math.min(this.data.left + this.data.width, Math.max(this.data.left, x));
      const [x, end] = [inside(Math.min(from, to)), inside(Math.max(from, to))];
      const strips = this.data.strips;
      const last = strips[strips.length - 1];
      const [y, height] = [strips[0].top, last.top + last.height - strips[0].top];
      element("rect", { x, y, width: end - x, height, fill: MARK, "fill-opacity": 0.15 }, this.overlay);
    }

    zoomBy(factor) {
      const [low, high] = this.range;
      const centre = this.line === null ? (low + high) / 2 : this.lines[this.line];
      this.show([centre - (centre - low) * factor, centre + (high - centre) * factor]);
    }

    // Shows a range of frequency, in every figure if they zoom together.
    show(range) {
      for (const chart of zoomsTogether() ? charts : [this]) {
        chart.draw(range === this.whole ? chart.whole : range);
      }
    }

    draw(asked) {
      const range = [Math.max(asked[0], this.whole[0]), Math.min(asked[1], this.whole[1])];
      if (!(this.firstFrom(range[1]) - this.firstFrom(range[0]) >= FEWEST_LINES)) return;
      const isWhole = range[0] === this.whole[0] && range[1] === this.whole[1];
      this.range = isWhole ? this.whole : range;
      this.fitted = null;
      this.zoomed?.remove();
      this.zoomed = null;
      this.still.style.display = isWhole ? "" : "none";
      this.figure.dataset.range = isWhole ? "" : range.map((hz) => hz.toPrecision(6)).join(" ");
      if (!isWhole) {
        this.zoomed = this.svg();
        this.picture.insertBefore(this.zoomed, this.overlay);
      }
      this.pointAt(this.line);
    }

    // The axes of the strips for the range shown: logarithmic ones fit what can be seen.
    axes() {
      if (this.range === this.whole) return this.data.strips.map((strip) => strip.axis);
      this.fitted ??= this.data.strips.map((strip) => this.fittedAxis(strip));
      return this.fitted;
    }

    fittedAxis({ axis, curves }) {
      if (!axis || axis.scale !== "logarithmic") return axis;
      let [low, high] = [Infinity, 0];
      const [first, end] = [this.firstFrom(this.range[0]), this.firstFrom(this.range[1])];
      for (const { values } of curves) {
        for (let line = first; line < end; line += 1) {
          if (values[line] > 0 && values[line] < Infinity) {
            low = Math.min(low, values[line]);
            high = Math.max(high, values[line]);
          }
        }
      }
      if (!(high > 0)) return axis;
      return { scale: axis.scale, low: Math.max(seriesAtMost(low / 1.25), Math.min(axis.low, high / 10)), high: seriesAtLeast(high * 1.25) };
    }

    svg() {
      const { data } = this;
      const svg = element("svg", { viewBox: `0 0 ${WIDTH} ${data.height}`, role: "img", "font-family": FONTS });
      element("title", {}, svg, `${this.still.querySelector("title").textContent}, zoomed`);
      element("rect", { width: WIDTH, height: data.height, fill: "#fff" }, svg);
      const axis = { scale: "linear", low: this.range[0], high: this.range[1] };
      const across = ticks(axis, Math.floor(data.width / 60));
      this.labelMarks(svg);
      data.strips.forEach((strip, number) => this.drawStrip(svg, strip, number, across));
      const bottom = Math.max(...data.strips.map((strip) => strip.top + strip.height));
      for (const { value, label } of across.major) {
        this.text(svg, this.placeOf(value), bottom + 16, label, "middle");
      }
      this.text(svg, data.left + data.width / 2, bottom + 34, "frequency, Hz", "middle");
      return svg;
    }

    text(svg, x, y, text, anchor, more = {}) {
      return element("text", { x, y, "font-size": 12, "text-anchor": anchor, fill: INK, ...more }, svg, text);
    }

    // Writes the frequencies of resonances, the most prominent first, where there is room.
    labelMarks(svg) {
      const taken = [];
      for (const hz of this.data.marks) {
        const x = this.placeOf(hz);
        if (hz < this.range[0] || hz > this.range[1] || taken.some((other) => Math.abs(other - x) < 48)) continue;
        taken.push(x);
        this.text(svg, x, this.data.strips[0].top - 6, hz.toFixed(1), "middle", { "font-size": 11.5, fill: MARK });
      }
    }

    drawStrip(svg, strip, number, across) {
      const { left, width } = this.data;
      const axis = this.axes()[number];
      const bottom = strip.top + strip.height;
      const y = (value) => bottom - position(axis, value) * strip.height;
      const up = axis ? ticks(axis, Math.floor(strip.height / 26)) : { major: [], minor: [] };
      const path = (d, stroke, more = {}, parent = svg) => element("path", { d, fill: "none", stroke, ...more }, parent);
      const level = (value, length) => `M${left} ${y(value)}h${length}`;
      const upright = (hz, from, to) => `M${this.placeOf(hz)} ${from}V${to}`;
      path(up.minor.map((value) => level(value, width)).join(""), MINOR_GRID);
      path(up.major.map((tick) => level(tick.value, width)).join("") + across.major.map((tick) => upright(tick.value, strip.top, bottom)).join(""), GRID);

      const clip = `${this.figure.id}-clip-${number}`;
      const shape = element("clipPath", { id: clip }, svg);
      element("rect", { x: left, y: strip.top, width, height: strip.height }, shape);
      const inside = element("g", { "clip-path": `url(#${clip})` }, svg);
      for (const [from, to] of strip.bands) {
        const x = this.placeOf(from);
        element("rect", { x, y: strip.top, width: this.placeOf(to) - x, height: strip.height, fill: BAND, "fill-opacity": 0.3 }, inside);
      }
      if (strip.level && axis) {
        const { value, low, high, colour } = strip.level;
        element("rect", { x: left, y: y(high), width, height: y(low) - y(high), fill: colour, "fill-opacity": 0.22 }, inside);
        path(level(value, width), colour, { "stroke-width": 1.6 }, inside);
      }
      const marks = this.data.marks.map((hz) => upright(hz, strip.top, bottom)).join("");
      path(marks, MARK, { "stroke-dasharray": "1 3" }, inside);
      for (const curve of axis ? strip.curves : []) {
        const cap = curve.dashes ? { "stroke-dasharray": curve.dashes } : { "stroke-linecap": "round" };
        const drawn = curve.dots ? this.dots(curve.values, y) : this.polyline(curve.values, y, axis.scale === "phase");
        path(drawn, curve.colour, { "stroke-width": curve.width, "stroke-linejoin": "round", ...cap }, inside);
      }

      const tickMarks = [
        ...up.minor.map((value) => level(value, 3)),
        ...up.major.map((tick) => level(tick.value, 5)),
        ...across.minor.map((hz) => upright(hz, bottom, bottom - 3)),
        ...across.major.map((tick) => upright(tick.value, bottom, bottom - 5)),
      ];
      path(tickMarks.join(""), FRAME);
      element("rect", { x: left, y: strip.top, width, height: strip.height, fill: "none", stroke: FRAME }, svg);
      for (const { value, label } of up.major) this.text(svg, left - 6, y(value) + 4.3, label, "end");
      const name = strip.unit ? `${strip.name}, ${strip.unit}` : strip.name;
      const middle = strip.top + strip.height / 2;
      this.text(svg, 0, 0, name, "middle", { transform: `translate(${left - 50} ${middle}) rotate(-90)` });
    }

    // Numbers of the lines in the range, with one neighbour at either end.
    seen() {
      const first = Math.max(0, this.firstFrom(this.range[0]) - 1);
      return [first, Math.min(this.lines.length, this.firstFrom(this.range[1]) + 2)];
    }

    dots(values, y) {
      const [first, end] = this.seen();
      let d = "";
      for (let line = first; line < end; line += 1) {
        const height = y(values[line]);
        if (Number.isFinite(height)) d += `M${this.placeOf(this.lines[line]).toFixed(2)} ${height.toFixed(2)}h0`;
      }
      return d;
    }

    // A line with gaps where there is no value; a phase is carried to the edge where it passes ±180°.
    polyline(values, y, wraps) {
      const [first, end] = this.seen();
      let [d, pen] = ["", "M"];
      const to = (hz, value) => {
        d += `${pen}${this.placeOf(hz).toFixed(2)} ${y(value).toFixed(2)}`;
        pen = "L";
      };
      for (let line = first; line < end; line += 1) {
        if (!Number.isFinite(y(values[line]))) {
          pen = "M";
          continue;
        }
        const jump = pen === "L" ? values[line] - values[line - 1] : 0;
        if (wraps && Math.abs(jump) > 180) {
          const edge = values[line - 1] < 0 ? -180 : 180;
          const share = (edge - values[line - 1]) / (jump - Math.sign(jump) * 360);
          const hz = this.lines[line - 1] + (Number.isFinite(share) ? share : 0) * (this.lines[line] - this.lines[line - 1]);
          to(hz, edge);
          pen = "M";
          to(hz, -edge);
        }
        to(this.lines[line], values[line]);
      }
      return d;
    }
  }

  document.documentElement.classList.add("scripted");
  for (const figure of document.querySelectorAll("figure.chart")) charts.push(new Chart(figure));
  if (charts.length > 1) {
    const label = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.id = "together";
    label.className = "together";
    label.append(box, " Zoom all figures together");
    charts[0].figure.before(label);
    zoomsTogether = () => box.checked;
  }
})();
