// The figures of this page with cursor and zoom, drawn at the width that the screen has. Each figure brings its axes and
// values along; without this script the pictures stand as they are.
"use strict";
(() => {
  const PAPER = "#fff", INK = "#1f2328", FRAME = "#6e7781", GRID = "#e3e6ea", MINOR_GRID = "#f3f4f6", MARK = "#0072b2", BAND = "#f0e442";
  const FONTS = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";
  // Movements of the pointer below this (pixels) are a click; below the other, they go along one axis.
  const CLICK = 5, STRAIGHT = 18;
  const FEWEST_LINES = 3;
  const SAVED_WIDTH = 960, NARROW = 560;

  const charts = [];
  let zoomsTogether = () => false;

  const element = (name, attributes = {}, parent = null, text = null) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== null) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  };
  const html = (name, properties, parent = null) => {
    const made = Object.assign(document.createElement(name), properties);
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
  const within = (value, low, high) => Math.min(high, Math.max(low, value));

  // Four significant digits.
  const shown = (value) => {
    if (!Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const power = decade(value);
    if (power >= -3 && power < 6) return minus(value.toFixed(Math.max(0, 3 - power)));
    const [mantissa, exponent] = value.toExponential(3).split("e");
    return `${minus(mantissa)} × 10${raised(Number(exponent))}`;
  };
  // "frequency, Hz" and 12.5 are "frequency 12.5 Hz".
  const named = (label, value) => {
    const [, name, unit] = label.match(/^(.*), (.+)$/) ?? [null, label, ""];
    return `${name} ${minus(String(Number(value.toPrecision(7))))} ${unit}`.trim();
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

  // Distances along an axis: of logarithms, or of the values themselves.
  const spread = (axis, value) => (axis.scale === "logarithmic" ? (value > 0 ? Math.log10(value) : NaN) : value);
  const unspread = (axis, place) => (axis.scale === "logarithmic" ? 10 ** place : place);
  const position = (axis, value) => {
    const [low, high] = [spread(axis, axis.low), spread(axis, axis.high)];
    return (spread(axis, value) - low) / (high - low);
  };
  const valueAt = (axis, share) => {
    const [low, high] = [spread(axis, axis.low), spread(axis, axis.high)];
    return unspread(axis, low + share * (high - low));
  };

  const ticks = (axis, most) => {
    const label = (value) => ({ value, label: minus(String(value)) });
    if (axis.scale === "phase" && axis.high - axis.low > 180) {
      return { major: [-180, -90, 0, 90, 180].map(label), minor: [-135, -45, 45, 135] };
    }
    if (axis.scale === "counted") {
      const count = Math.floor(axis.high);
      return { major: Array.from({ length: count }, (_, index) => label(index + 1)), minor: [] };
    }
    const steep = axis.scale === "logarithmic" && axis.high / axis.low >= 2.5;
    return steep ? logarithmicTicks(axis, most) : linearTicks(axis, most);
  };

  const linearTicks = ({ low, high }, most) => {
    const step = seriesAtLeast((high - low) / Math.max(1, most));
    const parts = Math.round(step / 10 ** decade(step)) === 2 ? 4 : 5;
    const decimals = Math.max(0, -decade(step));
    const largest = Math.max(Math.abs(low), Math.abs(high));
    const label = (value) =>
      largest < 1e-3 || largest >= 1e6
        ? value === 0 ? "0" : `${Number((value / 10 ** decade(largest)).toFixed(Math.max(0, decade(largest) - decade(step))))}·10${raised(decade(largest))}`
        : (value + 0).toFixed(decimals);
    const found = { major: [], minor: [] };
    for (let n = Math.ceil((low * parts) / step - 1e-9); n <= (high * parts) / step + 1e-9; n += 1) {
      const value = (n * step) / parts;
      if (n % parts === 0) found.major.push({ value, label: minus(label(value)) });
      else found.minor.push(value);
    }
    return found;
  };

  const logarithmicTicks = ({ low, high }, most) => {
    const decades = Math.log10(high / low);
    const stride = Math.max(1, Math.ceil(decades / Math.max(1, most)));
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

  // The longest of texts, and the longest that a curve's values have in the key: that of the smallest or of the largest.
  const longest = (texts) => texts.reduce((best, text) => (text.length > best.length ? text : best), "");
  const widest = (values) => {
    let [least, most, sign] = [Infinity, 0, 1];
    for (const value of values) {
      if (value < 0) sign = -1;
      const size = Math.abs(value);
      if (!(size > 0 && size < Infinity)) continue;
      least = Math.min(least, size);
      most = Math.max(most, size);
    }
    return longest([least, most].map((size) => shown(sign * size)));
  };

  const save = (name, blob) => {
    const link = html("a", { href: URL.createObjectURL(blob), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  };
  const fileName = (figure, ending) => {
    const title = document.querySelector("h1")?.textContent ?? "report";
    return `${title}-${figure.id}`.replace(/[^\p{L}\p{N}.-]+/gu, "-") + ending;
  };
  // Without the page's style a picture has its own colours, which are those for white paper.
  const savePng = (figure, svg) => {
    const [, , width, height] = svg.getAttribute("viewBox").split(/[\s,]+/).map(Number);
    svg.setAttribute("width", 2 * width);
    svg.setAttribute("height", 2 * height);
    const image = new Image();
    image.onload = () => {
      const canvas = html("canvas", { width: 2 * width, height: 2 * height });
      const paper = canvas.getContext("2d");
      paper.fillStyle = PAPER;
      paper.fillRect(0, 0, 2 * width, 2 * height);
      paper.drawImage(image, 0, 0, 2 * width, 2 * height);
      canvas.toBlob((blob) => save(fileName(figure, ".png"), blob), "image/png");
    };
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(svg))}`;
  };
  const controls = (figure, buttons) => {
    const row = html("div", { className: "controls" });
    for (const [textContent, title, onclick] of buttons) html("button", { type: "button", textContent, title, onclick }, row);
    figure.querySelector("figcaption").after(row);
  };

  class Chart {
    constructor(figure) {
      this.figure = figure;
      this.data = JSON.parse(figure.querySelector("script").textContent);
      this.lines = floats(this.data.lines);
      this.groups = [];
      this.entries = [];
      this.data.panels.forEach((panel, number) => {
        panel.number = number;
        if (panel.below) this.groups[this.groups.length - 1].panels.push(panel);
        else this.groups.push({ panels: [panel], range: null });
        panel.group = this.groups[this.groups.length - 1];
        panel.range = null;
        for (const curve of panel.curves) {
          for (const key of ["x", "y", "low", "high"]) if (curve[key] !== undefined) curve[key] = floats(curve[key]);
          curve.shared = curve.x === undefined;
          if (curve.shared) curve.x = this.lines;
          curve.entry = this.entry(curve.name || panel.title || panel.up.name, curve.look);
        }
        if (panel.level) panel.level.entry = this.entry(panel.level.name, panel.level.look);
      });
      this.at = null;
      this.picture = figure.querySelector(".picture");
      this.picture.replaceChildren();
      figure.querySelector("ul.keys")?.remove();
      figure.tabIndex = 0;
      controls(figure, [
        ["+", "Zoom in", () => this.zoomBy(0.5)],
        ["−", "Zoom out", () => this.zoomBy(2)],
        ["whole range", "Show the whole range", () => this.whole()],
        ["PNG", "Save the picture as PNG", () => savePng(figure, this.svg(SAVED_WIDTH, true))],
        ["CSV", "Save the values as a table", () => save(fileName(figure, ".csv"), new Blob([this.csv()], { type: "text/csv" }))],
      ]);
      this.legend();
      this.listen();
      this.draw();
      const fit = () => {
        if (Math.abs(this.room() - this.width) > 1 || this.figure.clientWidth !== this.reserved) this.draw();
      };
      // Later, as drawing changes the height of what is observed.
      new ResizeObserver(() => requestAnimationFrame(fit)).observe(this.picture);
    }

    entry(name, look) {
      const key = JSON.stringify([name, look]);
      let found = this.entries.find((entry) => entry.key === key);
      if (!found) this.entries.push((found = { key, name, look, hidden: false }));
      return found;
    }

    // One row for each name and look, with the values at the cursor.
    legend() {
      const most = Math.max(...this.groups.map((group) => group.panels.length));
      const table = (this.keys = html("table", { className: "keys" }));
      const head = html("tr", {}, html("thead", {}, table));
      this.heads = Array.from({ length: most + 1 }, () => html("th", { scope: "col" }, head));
      this.heads[0].className = "at";
      const body = html("tbody", {}, table);
      for (const entry of this.entries) {
        const row = html("tr", {}, body);
        const button = html("button", { type: "button", title: "Hide or show" }, html("th", { scope: "row" }, row));
        button.setAttribute("aria-pressed", "true");
        button.append(this.sample(entry.look), ` ${entry.name}`);
        button.onclick = () => {
          entry.hidden = !entry.hidden;
          button.setAttribute("aria-pressed", String(!entry.hidden));
          this.at = null;
          this.draw();
        };
        entry.cells = Array.from({ length: most }, () => html("td", {}, row));
      }
      this.picture.before(table);
    }

    // What the key shows at most: a text for each column of its head, and one for each cell.
    widest() {
      if (this.most) return this.most;
      const cells = new Map();
      const add = (cell, text) => cells.set(cell, longest([cells.get(cell) ?? "", text]));
      for (const { panels } of this.groups) {
        panels.forEach((panel, place) => {
          const title = panel.title && this.groups.length > 1 ? `${panel.title}: ` : "";
          add(this.heads[place + 1], title + panel.up.name);
          if (panel.level) add(panel.level.entry.cells[place], shown(panel.level.value));
          for (const { x, y, low, high, entry } of panel.curves) {
            add(this.heads[0], longest(Array.from(x, (value) => named(panels[0].across.name, value))));
            // An interval may stand below its value, a number is in one piece.
            entry.cells[place].classList.toggle("interval", low !== undefined);
            add(entry.cells[place], widest(y) + (low ? ` (${widest(low)} … ${widest(high)})` : ""));
          }
        });
      }
      return (this.most = [...cells]);
    }

    // Keeps the room of the widest readings, as the picture is not to move below a finger when they come and go.
    reserve() {
      if (this.figure.clientWidth === this.reserved) return;
      this.reserved = this.figure.clientWidth;
      this.keys.classList.remove("reserved");
      for (const [cell, text] of this.widest()) cell.textContent = text;
      const sizes = [this.keys, ...this.heads, ...this.keys.rows].map((each) => [each, each.getBoundingClientRect()]);
      for (const [each, { width, height }] of sizes) {
        // Other digits in the same number of places may be a little wider.
        each.style.setProperty("--across", `${Math.ceil(width) + 2}px`);
        each.style.setProperty("--down", `${height}px`);
      }
      this.keys.classList.add("reserved");
    }

    sample(look) {
      const svg = element("svg", { class: "key", viewBox: "0 0 22 12", width: 22, height: 12, "aria-hidden": "true" });
      this.stroke(svg, look.dots ? "M4 6h0M11 6h0M18 6h0" : "M1 6h20", look);
      return svg;
    }

    stroke(parent, d, look, dashes = look.dashes) {
      const cap = dashes && !look.dots ? { "stroke-dasharray": dashes } : { "stroke-linecap": "round" };
      return element("path", { d, fill: "none", stroke: look.colour, "stroke-width": look.width, "stroke-linejoin": "round", ...cap }, parent);
    }

    room() {
      return within(Math.floor(this.picture.clientWidth), 300, 1000);
    }

    listen() {
      const pointers = new Map();
      let start = null, pinch = null, held = null;
      const onPage = () => {
        const { left, top, width, height } = this.overlay.getBoundingClientRect();
        return { left: left + scrollX, top: top + scrollY, width, height };
      };
      // During a drag the picture is where it was at first: only what the pointer moves counts.
      const place = (event) => {
        const box = held ?? onPage();
        return { x: ((event.pageX - box.left) / box.width) * this.width, y: ((event.pageY - box.top) / box.height) * this.height };
      };
      const dragged = (x) => start && !pinch && Math.max(Math.abs(x.x - start.x), Math.abs(x.y - start.y)) > CLICK;
      this.picture.addEventListener("pointerdown", (event) => {
        if (event.button !== 0) return;
        if (pointers.size === 0) held = onPage();
        pointers.set(event.pointerId, place(event));
        if (pointers.size === 2) {
          const panel = this.panelAt([...pointers.values()][0]);
          pinch = { panel, places: [...pointers.values()], across: this.across(panel), up: this.up(panel) };
        } else if (pointers.size === 1) start = place(event);
        try {
          this.picture.setPointerCapture(event.pointerId);
        } catch {
          // The pointer has gone already.
        }
      });
      this.picture.addEventListener("pointermove", (event) => {
        const at = place(event);
        if (pointers.has(event.pointerId)) pointers.set(event.pointerId, at);
        if (pinch && pointers.size === 2) return this.pinched(pinch, [...pointers.values()]);
        if (!dragged(at)) return this.pointAt(at);
        this.pointAt(null);
        this.select(this.box(start, at));
      });
      const end = (event) => {
        const at = place(event);
        if (event.type === "pointerup" && pointers.size === 1) {
          if (dragged(at)) this.zoomTo(this.box(start, at));
          else if (start && !pinch) this.pointAt(at);
        } else this.pointAt(null);
        pointers.delete(event.pointerId);
        if (pointers.size === 0) start = pinch = held = null;
      };
      this.picture.addEventListener("pointerup", end);
      this.picture.addEventListener("pointercancel", end);
      this.picture.addEventListener("pointerleave", (event) => {
        if (!start && event.pointerType !== "touch") this.pointAt(null);
      });
      this.picture.addEventListener("dblclick", () => this.whole());
      this.figure.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "BUTTON") return;
        const step = event.shiftKey ? 10 : 1;
        const acts = {
          ArrowLeft: () => this.walk(-step),
          ArrowRight: () => this.walk(step),
          "+": () => this.zoomBy(0.5),
          "-": () => this.zoomBy(2),
          0: () => this.whole(),
          Escape: () => this.whole(),
        };
        const act = acts[event.key];
        if (act) {
          event.preventDefault();
          act();
        }
      });
    }

    // Axes as they are shown.
    across(panel) {
      const { range } = panel.group;
      const axis = panel.group.panels[0].across;
      return range ? { ...axis, low: range[0], high: range[1] } : axis;
    }

    up(panel) {
      if (panel.up.scale === null) return null;
      if (panel.range) return { ...panel.up, low: panel.range[0], high: panel.range[1] };
      const hidden = panel.curves.some((curve) => curve.entry.hidden) && !panel.curves.every((curve) => curve.entry.hidden);
      if (!panel.group.range && !hidden) return panel.up;
      return (panel.fitted ??= this.fitted(panel));
    }

    visible(panel) {
      return panel.curves.filter((curve) => !curve.entry.hidden);
    }

    // An axis that fits what can be seen.
    fitted(panel) {
      const { up } = panel;
      if (up.scale !== "logarithmic" && up.scale !== "linear") return up;
      const across = this.across(panel);
      let [low, high] = [Infinity, -Infinity];
      for (const { x, y, low: from = y, high: to = y } of this.visible(panel)) {
        for (let index = 0; index < y.length; index += 1) {
          if (x[index] < across.low || x[index] > across.high) continue;
          for (const value of [from[index], to[index]]) {
            if (!Number.isFinite(spread(up, value))) continue;
            low = Math.min(low, value);
            high = Math.max(high, value);
          }
        }
      }
      if (panel.level && !panel.level.entry.hidden) [low, high] = [Math.min(low, panel.level.low), Math.max(high, panel.level.high)];
      if (!(high >= low)) return up;
      if (up.scale === "logarithmic") {
        return { ...up, low: Math.max(seriesAtMost(low / 1.25), Math.min(up.low, high / 10)), high: seriesAtLeast(high * 1.25) };
      }
      const margin = 0.06 * (high - low) || 0.05 * Math.abs(high) || 0.5;
      // Values beyond the axis, which are few, stay there.
      return { ...up, low: Math.max(low - margin, up.low), high: Math.min(high + margin, up.high) };
    }

    // Where everything lies in a picture of so many pixels across.
    layout(width, top) {
      const columns = width < NARROW ? 1 : this.data.columns;
      const axes = this.data.panels.map((panel) => {
        const axis = this.up(panel);
        return axis ? ticks(axis, Math.floor(panel.height / 30)) : { major: [], minor: [] };
      });
      const labels = axes.flatMap((axis) => axis.major.map((tick) => tick.label.length));
      const left = 28 + 7 * Math.max(3, ...labels);
      const places = [];
      const column = width / columns;
      for (let row = 0; row * columns < this.groups.length; row += 1) {
        let bottom = top;
        this.groups.slice(row * columns, (row + 1) * columns).forEach((group, place) => {
          let y = top + 8;
          for (const panel of group.panels) {
            if (panel.title) y += 20;
            if (!panel.below && panel.marks.length) y += 16;
            const room = column - left - 14;
            const size = panel.square ? Math.min(room, panel.height) : room;
            const height = panel.square ? size : panel.height;
            places[panel.number] = { left: place * column + left + 0.5, top: y + 0.5, width: size, height, ticks: axes[panel.number] };
            y += height + 14;
          }
          bottom = Math.max(bottom, y + 28);
        });
        top = bottom;
      }
      return { places, height: Math.ceil(top) };
    }

    panelAt({ x, y }) {
      const away = ({ left, top, width, height }) =>
        Math.max(left - x, x - left - width, 0) + Math.max(top - y, y - top - height, 0);
      const nearest = this.places.reduce((best, place, number) => (away(place) < away(this.places[best]) ? number : best), 0);
      return this.data.panels[nearest];
    }

    placeOf(panel, x, y) {
      const place = this.places[panel.number];
      const up = this.up(panel);
      return {
        x: place.left + place.width * position(this.across(panel), x),
        y: up ? place.top + place.height * (1 - position(up, y)) : NaN,
      };
    }

    // Number of the first line that is not below `value`.
    firstFrom(value) {
      let [low, high] = [0, this.lines.length];
      while (low < high) {
        const middle = (low + high) >> 1;
        if (this.lines[middle] < value) low = middle + 1;
        else high = middle;
      }
      return low;
    }

    nearestLine(value) {
      const after = Math.min(this.firstFrom(value), this.lines.length - 1);
      const before = Math.max(after - 1, 0);
      return value - this.lines[before] < this.lines[after] - value ? before : after;
    }

    // The point of a curve that is nearest to a place: across before up, since a curve may turn back.
    nearestPoint(panel, curve, at) {
      let [best, least] = [null, Infinity];
      for (let index = 0; index < curve.x.length; index += 1) {
        const place = this.placeOf(panel, curve.x[index], curve.y[index]);
        const distance = 9 * (place.x - at.x) ** 2 + (place.y - at.y) ** 2;
        if (distance < least) [best, least] = [index, distance];
      }
      return best;
    }

    // Moves the cursor to a place, or takes it away.
    pointAt(at) {
      if (!at) return this.show(null);
      const panel = this.panelAt(at);
      const { group } = panel;
      const place = this.places[panel.number];
      const wanted = valueAt(this.across(panel), within((at.x - place.left) / place.width, 0, 1));
      const line = this.lines.length ? this.nearestLine(wanted) : null;
      const picks = [];
      for (const of of group.panels) {
        for (const curve of this.visible(of)) {
          const index = curve.shared ? line : this.nearestPoint(of, curve, at);
          if (index !== null) picks.push({ panel: of, curve, index });
        }
      }
      const far = ({ panel: of, curve, index }) => {
        const found = this.placeOf(of, curve.x[index], curve.y[index]);
        return Number.isFinite(found.y) ? Math.hypot(found.x - at.x, of === panel ? found.y - at.y : 1e6) : Infinity;
      };
      const first = picks.reduce((best, pick) => (best === null || far(pick) < far(best) ? pick : best), null);
      this.show(first && { group, panel, picks, first });
    }

    walk(step) {
      if (!this.at) {
        const place = this.places[0];
        return this.pointAt({ x: place.left + place.width / 2, y: place.top + place.height / 2 });
      }
      const { first, panel, picks, group } = this.at;
      const index = within(first.index + step, 0, first.curve.x.length - 1);
      const axis = this.across(panel);
      const value = first.curve.x[index];
      if (value < axis.low || value > axis.high) return;
      const at = this.placeOf(first.panel, value, first.curve.y[index]);
      const moved = picks.map((pick) => ({
        ...pick,
        index: pick.curve === first.curve || (pick.curve.shared && first.curve.shared) ? index : this.nearestPoint(pick.panel, pick.curve, at),
      }));
      this.show({ group, panel, picks: moved, first: moved[picks.indexOf(first)] });
    }

    show(at) {
      this.at = at;
      this.overlay.replaceChildren();
      const panels = (at ?? { group: this.groups[0] }).group.panels;
      this.heads[0].textContent = at ? named(at.group.panels[0].across.name, at.first.curve.x[at.first.index]) : "";
      this.heads.slice(1).forEach((head, number) => {
        const panel = panels[number];
        const title = at && panel?.title && this.groups.length > 1 ? `${panel.title}: ` : "";
        head.textContent = panel && (at || this.groups.length === 1) ? title + panel.up.name : "";
      });
      for (const { cells } of this.entries) for (const cell of cells) cell.textContent = "";
      if (!at) return;
      for (const panel of panels) {
        const { level } = panel;
        if (level) level.entry.cells[panels.indexOf(panel)].textContent = shown(level.value);
      }
      for (const { panel, curve, index } of at.picks) {
        const ends = curve.low ? ` (${shown(curve.low[index])} … ${shown(curve.high[index])})` : "";
        curve.entry.cells[panels.indexOf(panel)].textContent = shown(curve.y[index]) + ends;
      }
      for (const panel of panels) {
        const place = this.places[panel.number];
        const { x } = this.placeOf(panel, at.first.curve.x[at.first.index], 1);
        if (!(x >= place.left - 0.01 && x <= place.left + place.width + 0.01)) continue;
        element("line", { x1: x, x2: x, y1: place.top, y2: place.top + place.height, stroke: INK, "stroke-width": 1 }, this.overlay);
      }
      for (const { panel, curve, index } of at.picks) {
        const place = this.places[panel.number];
        const { x, y } = this.placeOf(panel, curve.x[index], curve.y[index]);
        if (!(x >= place.left - 0.01 && x <= place.left + place.width + 0.01 && y >= place.top - 0.01 && y <= place.top + place.height + 0.01)) continue;
        element("circle", { cx: x, cy: y, r: 3.6, fill: PAPER, stroke: curve.look.colour, "stroke-width": 2 }, this.overlay);
      }
    }

    // What a drag from one place to another means: along, up, or a part of a panel.
    box(from, to) {
      const panel = this.panelAt(from);
      const place = this.places[panel.number];
      const [dx, dy] = [Math.abs(to.x - from.x), Math.abs(to.y - from.y)];
      const along = dx >= STRAIGHT || dx >= dy;
      const up = this.up(panel) !== null && (dy >= STRAIGHT || dy > dx);
      const share = (value, start, length) => within((value - start) / length, 0, 1);
      const sorted = (a, b) => (a < b ? [a, b] : [b, a]);
      return {
        panel,
        along: along ? sorted(share(from.x, place.left, place.width), share(to.x, place.left, place.width)) : null,
        up: up ? sorted(1 - share(from.y, place.top, place.height), 1 - share(to.y, place.top, place.height)) : null,
      };
    }

    select({ panel, along, up }) {
      for (const of of up ? [panel] : panel.group.panels) {
        const place = this.places[of.number];
        const [left, right] = along ?? [0, 1];
        const [low, high] = up ?? [0, 1];
        const box = { x: place.left + left * place.width, width: (right - left) * place.width,
          y: place.top + (1 - high) * place.height, height: (high - low) * place.height };
        element("rect", { ...box, fill: MARK, "fill-opacity": 0.15 }, this.overlay);
      }
    }

    zoomTo({ panel, along, up }) {
      const part = (axis, ends) => ends.map((share) => valueAt(axis, share));
      const ranges = [along && part(this.across(panel), along), up && part(this.up(panel), up)];
      if (ranges[1]) this.setUp(panel, ranges[1]);
      if (ranges[0]) this.setAcross(panel.group, ranges[0]);
      this.draw();
    }

    pinched({ panel, places, across, up }, now) {
      const place = this.places[panel.number];
      const range = (axis, from, to) => {
        if (!axis || Math.abs(to[0] - to[1]) < 0.08 || Math.abs(from[0] - from[1]) < 0.08) return null;
        const [low, high] = [spread(axis, axis.low), spread(axis, axis.high)];
        const values = from.map((share) => low + share * (high - low));
        const per = (values[1] - values[0]) / (to[1] - to[0]);
        if (!(per > 0)) return null;
        return [values[0] - to[0] * per, values[0] + (1 - to[0]) * per].map((value) => unspread(axis, value));
      };
      const x = (all) => all.map((at) => (at.x - place.left) / place.width);
      const y = (all) => all.map((at) => 1 - (at.y - place.top) / place.height);
      const [along, upright] = [range(across, x(places), x(now)), range(up, y(places), y(now))];
      if (upright) this.setUp(panel, upright);
      if (along) this.setAcross(panel.group, along);
      this.draw();
    }

    setUp(panel, [low, high]) {
      const { up } = panel;
      const [from, to] = [Math.max(low, up.low), Math.min(high, up.high)];
      if (!(spread(up, to) - spread(up, from) > 1e-6 * (spread(up, up.high) - spread(up, up.low)))) return;
      panel.range = from === up.low && to === up.high ? null : [from, to];
    }

    // Shows a range of the abscissa, in every figure of the same one if they zoom together.
    setAcross(group, range) {
      const name = group.panels[0].across.name;
      const together = zoomsTogether() ? charts.flatMap((chart) => chart.groups.map((other) => [chart, other])) : [];
      const others = together.filter(([, other]) => other.panels[0].across.name === name);
      for (const [chart, other] of others.length ? others : [[this, group]]) {
        const axis = other.panels[0].across;
        const ends = range ? [Math.max(range[0], axis.low), Math.min(range[1], axis.high)] : null;
        if (ends) {
          if (!(ends[1] > ends[0])) continue;
          const shares = other.panels[0].curves.some((curve) => curve.shared);
          if (shares && chart.firstFrom(ends[1]) - chart.firstFrom(ends[0]) < FEWEST_LINES) continue;
          if (spread(axis, ends[1]) - spread(axis, ends[0]) < 1e-6 * (spread(axis, axis.high) - spread(axis, axis.low))) continue;
        }
        other.range = ends && (ends[0] > axis.low || ends[1] < axis.high) ? ends : null;
        if (chart !== this) chart.draw();
      }
    }

    zoomBy(factor) {
      const groups = this.at ? [this.at.group] : this.groups;
      for (const group of groups) {
        const axis = this.across(group.panels[0]);
        const [low, high] = [spread(axis, axis.low), spread(axis, axis.high)];
        const centre = this.at ? spread(axis, this.at.first.curve.x[this.at.first.index]) : (low + high) / 2;
        this.setAcross(group, [centre - (centre - low) * factor, centre + (high - centre) * factor].map((value) => unspread(axis, value)));
      }
      this.draw();
    }

    whole() {
      for (const panel of this.data.panels) panel.range = null;
      for (const group of this.groups) this.setAcross(group, null);
      this.draw();
    }

    draw(width = this.room()) {
      this.width = width;
      for (const panel of this.data.panels) panel.fitted = null;
      const svg = this.svg(width, false);
      this.height = Number(svg.getAttribute("viewBox").split(" ")[3]);
      const overlay = { viewBox: `0 0 ${width} ${this.height}`, class: "overlay", "aria-hidden": "true" };
      this.overlay = element("svg", overlay);
      // The picture itself stays as wide as the page lets it be: its width says what room there is.
      for (const layer of [svg, this.overlay]) layer.style.setProperty("--drawn", `${width}px`);
      this.picture.replaceChildren(svg, this.overlay);
      this.reserve();
      const written = (range) => (range ? range.map((value) => value.toPrecision(6)).join(" ") : "");
      this.figure.dataset.range = this.groups.map((group) => written(group.range)).find(Boolean) ?? "";
      this.figure.dataset.up = this.data.panels.map((panel) => written(panel.range)).find(Boolean) ?? "";
      this.show(this.at);
    }

    svg(width, isSaved) {
      const svg = element("svg", { role: "img", "font-family": FONTS });
      element("title", {}, svg, this.data.title);
      const paper = element("rect", { width, fill: PAPER }, svg);
      const head = isSaved ? this.head(svg, width) : 0;
      const { places, height } = this.layout(width, head);
      if (!isSaved) this.places = places;
      svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      paper.setAttribute("height", height);
      const shown = this.places;
      this.places = places;
      for (const group of this.groups) {
        const across = ticks(this.across(group.panels[0]), Math.floor(places[group.panels[0].number].width / 56));
        this.labelMarks(svg, group.panels[0]);
        for (const panel of group.panels) this.drawPanel(svg, panel, across);
        const last = group.panels[group.panels.length - 1];
        const place = places[last.number];
        for (const { value, label } of across.major) {
          // the last one is not to lose its end beyond the paper
          const most = place.left + place.width + 13 - 3.4 * label.length;
          this.text(svg, Math.min(this.placeOf(last, value, 1).x, most), place.top + place.height + 16, label, "middle");
        }
        this.text(svg, place.left + place.width / 2, place.top + place.height + 33, last.across.name, "middle");
      }
      this.places = shown;
      return svg;
    }

    // Title and key of a picture that is saved.
    head(svg, width) {
      const caption = this.figure.querySelector("figcaption").textContent;
      this.text(svg, 12, 22, `${document.querySelector("h1")?.textContent ?? ""}: ${caption}`.slice(0, 130), "start", { "font-size": 14, "font-weight": 600 });
      let [x, y] = [12, 46];
      for (const { name, look, hidden } of this.entries) {
        if (hidden) continue;
        const room = 46 + 7 * name.length;
        if (x + room > width) [x, y] = [12, y + 18];
        const sample = element("g", { transform: `translate(${x} ${y - 10})` }, svg);
        this.stroke(sample, look.dots ? "M4 6h0M11 6h0M18 6h0" : "M1 6h20", look);
        this.text(svg, x + 28, y, name, "start");
        x += room;
      }
      return y + 8;
    }

    text(svg, x, y, text, anchor, more = {}) {
      return element("text", { x, y, "font-size": 12, "text-anchor": anchor, fill: INK, ...more }, svg, text);
    }

    // Writes the frequencies of resonances, the most prominent first, where there is room.
    labelMarks(svg, panel) {
      const place = this.places[panel.number];
      const taken = [];
      for (const mark of panel.marks) {
        const { x } = this.placeOf(panel, mark, 1);
        if (!(x >= place.left && x <= place.left + place.width) || taken.some((other) => Math.abs(other - x) < 48)) continue;
        taken.push(x);
        this.text(svg, x, place.top - 6, mark.toFixed(1), "middle", { "font-size": 11.5, fill: MARK });
      }
    }

    drawPanel(svg, panel, across) {
      const { left, top, width, height, ticks: up } = this.places[panel.number];
      const axis = this.up(panel);
      const bottom = top + height;
      const path = (d, stroke, more = {}, parent = svg) => element("path", { d, fill: "none", stroke, ...more }, parent);
      const y = (value) => this.placeOf(panel, 1, value).y;
      const x = (value) => this.placeOf(panel, value, 1).x;
      const level = (value, length) => `M${left} ${y(value)}h${length}`;
      const upright = (value, from, to) => `M${x(value)} ${from}V${to}`;
      if (panel.title) this.text(svg, left, top - (panel.marks.length && !panel.below ? 22 : 7), panel.title, "start", { "font-weight": 600 });
      path(up.minor.map((value) => level(value, width)).join(""), MINOR_GRID);
      path(up.major.map((tick) => level(tick.value, width)).join("") + across.major.map((tick) => upright(tick.value, top, bottom)).join(""), GRID);

      const clip = `${this.figure.id}-clip-${panel.number}`;
      const shape = element("clipPath", { id: clip }, svg);
      element("rect", { x: left, y: top, width, height }, shape);
      const inside = element("g", { "clip-path": `url(#${clip})` }, svg);
      for (const [from, to] of panel.bands) {
        element("rect", { x: x(from), y: top, width: x(to) - x(from), height, fill: BAND, "fill-opacity": 0.3 }, inside);
      }
      if (panel.level && axis && !panel.level.entry.hidden) {
        const { value, low, high, look } = panel.level;
        element("rect", { x: left, y: y(high), width, height: y(low) - y(high), fill: look.colour, "fill-opacity": 0.22 }, inside);
        this.stroke(inside, level(value, width), look);
      }
      path(panel.marks.map((mark) => upright(mark, top, bottom)).join(""), MARK, { "stroke-dasharray": "1 3" }, inside);
      for (const curve of axis ? this.visible(panel) : []) this.drawCurve(inside, panel, curve, axis);

      const tickMarks = [
        ...up.minor.map((value) => level(value, 3)),
        ...up.major.map((tick) => level(tick.value, 5)),
        ...across.minor.map((value) => upright(value, bottom, bottom - 3)),
        ...across.major.map((tick) => upright(tick.value, bottom, bottom - 5)),
      ];
      path(tickMarks.join(""), FRAME);
      element("rect", { x: left, y: top, width, height, fill: "none", stroke: FRAME }, svg);
      for (const { value, label } of up.major) this.text(svg, left - 6, y(value) + 4.3, label, "end");
      if (!axis) this.text(svg, left + width / 2, top + height / 2, "nothing to draw", "middle");
      const longest = Math.max(0, ...up.major.map((tick) => tick.label.length));
      this.text(svg, 0, 0, panel.up.name, "middle", { transform: `translate(${left - 16 - 7 * Math.max(2, longest)} ${top + height / 2}) rotate(-90)` });
    }

    drawCurve(inside, panel, curve, axis) {
      const { look } = curve;
      if (curve.low) {
        const bars = Array.from(curve.x, (value, index) => {
          const [low, high] = [this.placeOf(panel, value, curve.low[index]), this.placeOf(panel, value, curve.high[index])];
          return `M${low.x} ${low.y}V${high.y}M${low.x - 5} ${low.y}h10M${low.x - 5} ${high.y}h10`;
        });
        this.stroke(inside, bars.join(""), { ...look, width: 1.6, dots: false });
        if (curve.joined) this.stroke(inside, this.polyline(panel, curve, false), { ...look, width: 1.2, dots: false }, "4 3");
      }
      if (look.dots) return this.stroke(inside, this.dots(panel, curve), look);
      if (!curve.dashed) return this.stroke(inside, this.polyline(panel, curve, axis.scale === "phase"), look);
      const is = (digit) => (index) => curve.dashed[index] === digit || curve.dashed[index + 1] === digit;
      this.stroke(inside, this.polyline(panel, curve, false, is("0")), look);
      this.stroke(inside, this.polyline(panel, curve, false, (index) => curve.dashed[index] === "1" && curve.dashed[index + 1] !== "0"), look, "4 3");
    }

    // Numbers of the points in the range, with one neighbour at either end.
    seen(panel, curve) {
      if (!curve.shared) return [0, curve.x.length];
      const { low, high } = this.across(panel);
      return [Math.max(0, this.firstFrom(low) - 1), Math.min(curve.x.length, this.firstFrom(high) + 2)];
    }

    dots(panel, curve) {
      const [first, end] = this.seen(panel, curve);
      let d = "";
      for (let index = first; index < end; index += 1) {
        const { x, y } = this.placeOf(panel, curve.x[index], curve.y[index]);
        if (Number.isFinite(x) && Number.isFinite(y)) d += `M${x.toFixed(2)} ${y.toFixed(2)}h0`;
      }
      return d;
    }

    // A line with gaps where there is no value; a phase is carried to the edge where it passes ±180°.
    polyline(panel, curve, wraps, includes = () => true) {
      const [first, end] = this.seen(panel, curve);
      const { x, y } = curve;
      let [d, pen] = ["", "M"];
      const to = (across, up) => {
        const place = this.placeOf(panel, across, up);
        d += `${pen}${place.x.toFixed(2)} ${place.y.toFixed(2)}`;
        pen = "L";
      };
      for (let index = first; index < end; index += 1) {
        const place = this.placeOf(panel, x[index], y[index]);
        if (!includes(index) || !Number.isFinite(place.x) || !Number.isFinite(place.y)) {
          pen = "M";
          continue;
        }
        const jump = pen === "L" ? y[index] - y[index - 1] : 0;
        if (wraps && Math.abs(jump) > 180) {
          const edge = y[index - 1] < 0 ? -180 : 180;
          const share = (edge - y[index - 1]) / (jump - Math.sign(jump) * 360);
          const across = x[index - 1] + (Number.isFinite(share) ? share : 0) * (x[index] - x[index - 1]);
          to(across, edge);
          pen = "M";
          to(across, -edge);
        }
        to(x[index], y[index]);
      }
      return d;
    }

    // A column for each curve; those with an abscissa of their own bring it along.
    csv() {
      const quoted = (text) => `"${text.replace(/"/g, '""')}"`;
      const columns = [];
      const add = (name, values) => columns.push([quoted(name), values]);
      if (this.lines.length) add(this.data.panels[0].across.name, this.lines);
      for (const panel of this.data.panels) {
        const title = panel.title ? `${panel.title}: ` : "";
        for (const curve of panel.curves) {
          const { name } = curve.entry;
          if (!curve.shared) add(`${title}${panel.across.name}: ${name}`, curve.x);
          add(`${title}${panel.up.name}: ${name}`, curve.y);
          if (curve.low) add(`${title}${panel.up.name}: ${name}, from`, curve.low);
          if (curve.low) add(`${title}${panel.up.name}: ${name}, to`, curve.high);
          if (curve.dashed) add(`${title}${name}: dashed`, Array.from(curve.dashed, Number));
        }
      }
      const rows = [columns.map(([name]) => name).join(",")];
      const longest = Math.max(...columns.map(([, values]) => values.length));
      const number = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(7))) : "");
      for (let row = 0; row < longest; row += 1) {
        rows.push(columns.map(([, values]) => (row < values.length ? number(values[row]) : "")).join(","));
      }
      return `${rows.join("\n")}\n`;
    }
  }

  document.documentElement.classList.add("scripted");
  for (const figure of document.querySelectorAll("figure.chart")) charts.push(new Chart(figure));
  for (const figure of document.querySelectorAll("figure.still")) {
    const svg = figure.querySelector(".picture svg");
    if (svg) controls(figure, [["PNG", "Save the picture as PNG", () => savePng(figure, svg.cloneNode(true))]]);
  }
  addEventListener("beforeprint", () => charts.forEach((chart) => chart.draw(SAVED_WIDTH)));
  addEventListener("afterprint", () => charts.forEach((chart) => chart.draw()));
  // A table that is wider than the page fades at the sides where there is more of it.
  for (const box of document.querySelectorAll(".scroll, .equation")) {
    const fade = () => {
      box.classList.toggle("before", box.scrollLeft > 1);
      box.classList.toggle("after", box.scrollLeft + box.clientWidth < box.scrollWidth - 1);
    };
    box.addEventListener("scroll", fade, { passive: true });
    new ResizeObserver(fade).observe(box);
  }
  const frequencies = charts.filter((chart) => chart.data.panels.some((panel) => panel.across.name === "frequency, Hz"));
  if (frequencies.length > 1) {
    const label = html("label", { className: "together" });
    const box = html("input", { type: "checkbox", id: "together" }, label);
    label.append(" Zoom all figures over frequency together");
    frequencies[0].figure.before(label);
    zoomsTogether = () => box.checked;
  }
})();
