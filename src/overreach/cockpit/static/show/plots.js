// Four plots over the last 20 s, by the charting library that the page brings along (ECharts).
// Each is a chart of its own and they take turns: a redraw takes milliseconds, and the view's next frame is near.

import { colour, onTheme } from "./theme.js";

const SPAN_S = 20;
const SAMPLE_S = 0.1;
const TURN_MS = 60;
const TURN_HELD_MS = 125; // while somebody drives, the pad goes first
const FONT = "system-ui, sans-serif"; // a canvas knows nothing of the style sheet

const PLOTS = {
  l: { series: [["l", "ink", (s) => s.l]], limits: ["l_min", "l_max"], pad: 0.1 },
  psi: { series: [["psi", "ink", (s) => s.psi]], limits: ["psi_min", "psi_max"], pad: 0.2 },
  linear: { series: [["v_b", "base", (s) => (s.base.v_y ? Math.hypot(s.base.v_x, s.base.v_y) : s.base.v_x)], ["v_m", "arm", (s) => s.v_m]], span: 0.5 },
  angular: { series: [["w_b", "base", (s) => s.base.w_z], ["w_m", "arm", (s) => s.w_m]], span: 0.5, time: true },
};

export class Plots {
  constructor(elements) {
    this.plots = elements.map((element) => new Plot(element, PLOTS[element.dataset.plot]));
    this.last = -Infinity;
    this.turn = 0;
    onTheme(() => this.plots.forEach((plot) => (plot.fresh = false)));
    import("nicegui-echart").then(({ echarts }) => {
      for (const plot of this.plots) plot.library = echarts;
    });
  }

  configure(workspace) {
    for (const plot of this.plots) {
      plot.workspace = workspace;
      plot.fresh = false;
    }
  }

  add(state) {
    if (state.t < this.last) for (const plot of this.plots) plot.clear();
    if (state.t - this.last < SAMPLE_S && state.t >= this.last) return;
    this.last = state.t;
    for (const plot of this.plots) plot.add(state);
  }

  // Called right after a frame is drawn: as long before the next one as possible.
  afterFrame(at, held) {
    if (at - this.turn < (held ? TURN_HELD_MS : TURN_MS)) return;
    this.turn = at;
    const plot = this.plots.shift();
    this.plots.push(plot);
    plot.refresh();
  }
}

class Plot {
  constructor(element, what) {
    this.element = element;
    this.what = what;
    this.clear();
  }

  clear() {
    this.data = this.what.series.map(() => []);
    this.end = 0;
  }

  add(state) {
    this.end = state.t;
    this.changed = true;
    this.what.series.forEach(([, , value], k) => {
      const points = this.data[k];
      points.push([state.t, value(state)]);
      while (points[0][0] < state.t - SPAN_S - 1) points.shift();
    });
  }

  refresh() {
    const chart = this.library?.getInstanceByDom(this.element);
    if (!chart || !this.workspace || !this.element.offsetParent) return;
    const range = this.vertical();
    if (!this.fresh || range.min !== this.range.min || range.max !== this.range.max) {
      chart.setOption(this.frame(range), { notMerge: true, silent: true });
      this.range = range;
      this.fresh = true;
      this.changed = true;
    }
    if (!this.changed) return;
    this.changed = false;
    // Time runs to the left of now: the axes stay as they are, and only the lines are made anew.
    const series = this.data.map((points) => ({ data: points.map(([t, value]) => [t - this.end, value]) }));
    chart.setOption({ series }, { silent: true });
  }

  vertical() {
    const { limits, pad = 0, span } = this.what;
    const wanted = limits ? limits.map((limit) => this.workspace[limit]) : [-span, span];
    let [min, max] = [Math.min(...wanted) - pad, Math.max(...wanted) + pad];
    for (const points of this.data) {
      for (const [, value] of points) {
        min = Math.min(min, value);
        max = Math.max(max, value);
      }
    }
    const step = max - min > 3 ? 1 : max - min > 0.9 ? 0.5 : 0.2;
    return { min: Math.floor(min / step + 1e-9) * step, max: Math.ceil(max / step - 1e-9) * step, interval: step };
  }

  // The limits are lines like the others, after them: a mark on a line would be laid out at every change.
  frame(range) {
    const [muted, line, base] = ["muted", "line", "base"].map(colour);
    const { series, limits = [], time = false } = this.what;
    const label = { color: muted, fontSize: 11, fontFamily: FONT };
    const plain = { type: "line", showSymbol: false, silent: true };
    return {
      animation: false,
      grid: { left: 34, right: 6, top: 6, bottom: time ? 18 : 6 },
      xAxis: {
        type: "value", min: -SPAN_S, max: 0, axisLine: { onZero: false, lineStyle: { color: line } }, splitLine: { show: false },
        axisTick: { show: false }, interval: SPAN_S / 4,
        axisLabel: { ...label, show: time, margin: 4, formatter: (t) => (t ? `${t} s`.replace("-", "−") : "now"), alignMaxLabel: "right", alignMinLabel: "left" },
      },
      yAxis: {
        type: "value", ...range, axisLine: { show: false }, axisTick: { show: false }, splitLine: { lineStyle: { color: line, opacity: 0.6 } },
        axisLabel: { ...label, formatter: (value) => (+value.toFixed(2)).toString().replace("-", "−") },
      },
      series: [
        ...series.map(([name, ink]) => ({ ...plain, name, data: [], lineStyle: { width: 1.8, color: colour(ink) } })),
        ...limits.map((limit) => ({
          ...plain, name: limit, lineStyle: { width: 1.2, color: base, type: "dashed" },
          data: [[-SPAN_S, this.workspace[limit]], [0, this.workspace[limit]]],
        })),
      ],
    };
  }
}
