// The look and the behaviour of the chart's page. The script draws from `data`, which chart_page.cpp puts before it.
#pragma once

namespace tutu::app {

inline constexpr const char* k_chart_page_style = R"(
.code,code{font-family:ui-monospace,monospace;font-size:.85rem}
code{user-select:all;overflow-wrap:anywhere}
svg .name{fill:#20242c}svg .failed{fill:#b00}
.front{stroke:#999;stroke-width:2;fill:none}
.point{cursor:pointer;stroke:#fff}.chosen{stroke:#000;stroke-width:2.5}
.cross{cursor:pointer;stroke:#c00;stroke-width:2.5}
th{cursor:pointer;color:#59616e}tbody tr{cursor:pointer}tbody tr:hover{background:#f2f5f9}
.bad{color:#b00}
)";

inline constexpr const char* k_chart_page_script = R"(
const columns = [['ms_p99','ms p99'],['ms_median','ms median'],['trajectory_mm_rms','first s, mm'],
  ['drape_mm_rms','drape, mm'],['drape_mm_hausdorff','Hausdorff, mm'],['in_body_mm_surface','surface in body, mm'],
  ['in_body_mm_p99','particles in body p99, mm'],['in_proxies_mm_surface','surface in proxies, mm'],
  ['in_proxies_mm_max','particles in proxies, mm'],['missed_contacts','missed'],
  ['false_contacts','false'],['longer_pct_p99','longer p99, %'],['longer_pct_max','longest, %'],
  ['shorter_pct_p99','shorter p99, %'],['jitter','jitter, m/s2'],['energy_drift_mj','drift, mJ'],
  ['most_substeps','most substeps'],['colliders','colliders'],['particles','particles']];
const colour = p => p.setting.backend === 'mesh' ? '#009e73' : p.setting.solver === 'mass_spring' ? '#d55e00'
  : p.setting.features === 'particles' ? '#56b4e9' : '#0072b2';
const short = v => v === undefined ? '' : v === 0 ? '0' : Math.abs(v) < 1e-3 ? v.toExponential(1)
  : String(+v.toPrecision(4));
const element = (name, attributes, text) => {
  const e = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const k in attributes) e.setAttribute(k, attributes[k]);
  if (text !== undefined) e.textContent = text;
  return e;
};
let chosen = -1, sorted = 'ms_p99', rising = true;
const select = document.getElementById('axis');
data.axes.forEach((a, i) => select.add(new Option(a.title, i)));
select.onchange = draw;

function choose(i) {
  chosen = i;
  const p = data.points[i], shown = document.getElementById('shown');
  shown.textContent = '';
  const add = (tag, text, kind) => {
    const e = document.createElement(tag);
    e.textContent = text;
    if (kind) e.className = kind;
    shown.append(e);
    return e;
  };
  add('b', p.name);
  if (p.failed) add('p', p.failed + ' of ' + p.runs + ' runs failed: ' + (p.why || p.reason), 'bad');
  add('p', Object.entries(p.setting).map(([k, v]) => k + ' ' + v).join(', '), 'soft');
  add('code', p.command);
  add('p', Object.entries(p.figures).map(([k, v]) => k + ' ' + short(v)).join(', ') + '; ' + p.machine, 'soft');
  draw();
  table();
}

function draw() {
  const axis = data.axes[select.value || 0], W = 1000, H = 560, L = 70, R = 20, T = 60, B = 50;
  const y_of = p => Math.max(axis.floor, axis.scale * p.figures[axis.column]);
  const good = p => !p.failed && p.figures.ms_p99 > 0 && p.figures[axis.column] !== undefined;
  const xs = data.points.filter(p => p.figures.ms_p99 > 0).map(p => p.figures.ms_p99);
  const ys = data.points.filter(good).map(y_of);
  const range = v => v.length ? [Math.log10(Math.min(...v)) - .1, Math.log10(Math.max(...v)) + .15] : [-1, 1];
  const [x0, x1] = range(xs), [y0, y1] = range(ys);
  const X = v => L + (Math.log10(v) - x0) / (x1 - x0) * (W - L - R);
  const Y = v => H - B - (Math.log10(v) - y0) / (y1 - y0) * (H - T - B);
  const svg = element('svg', {viewBox: '0 0 ' + W + ' ' + H});
  const ticks = (a, b) => {
    const list = [];
    for (let d = Math.floor(a); d <= b; ++d)
      for (const m of b - a > 2 ? [1] : [1, 2, 5]) {
        const v = m * 10 ** d, l = Math.log10(v);
        if (l >= a && l <= b) list.push(v);
      }
    return list;
  };
  for (const v of ticks(x0, x1)) {
    svg.append(element('line', {x1: X(v), x2: X(v), y1: T, y2: H - B, class: 'grid'}));
    svg.append(element('text', {x: X(v), y: H - B + 18, 'text-anchor': 'middle'}, short(v)));
  }
  for (const v of ticks(y0, y1)) {
    svg.append(element('line', {x1: L, x2: W - R, y1: Y(v), y2: Y(v), class: 'grid'}));
    svg.append(element('text', {x: L - 6, y: Y(v) + 4, 'text-anchor': 'end'}, short(v)));
  }
  svg.append(element('text', {x: (L + W) / 2, y: H - 10, 'text-anchor': 'middle'}, 'ms a frame, p99'));
  svg.append(element('text', {x: -H / 2, y: 16, transform: 'rotate(-90)', 'text-anchor': 'middle'}, axis.title));
  let path = '';
  axis.front.forEach((i, k) => {
    const p = data.points[i], x = X(p.figures.ms_p99), y = Y(y_of(p));
    path += k ? 'H' + x + 'V' + y : 'M' + x + ' ' + y;
  });
  if (path) svg.append(element('path', {d: path, class: 'front'}));
  data.points.forEach((p, i) => {
    if (!good(p)) {
      const x = p.figures.ms_p99 > 0 ? X(p.figures.ms_p99) : W - R - 8, y = 30;
      const cross = element('path', {d: 'M' + (x - 6) + ' ' + (y - 6) + 'l12 12m0 -12l-12 12', class: 'cross'});
      cross.onclick = () => choose(i);
      cross.append(element('title', {}, p.name + ': ' + p.reason));
      svg.append(cross);
      const right = x > W / 2;
      svg.append(element('text', {x: x + (right ? -10 : 10), y: y - 10 + 11 * (i % 3),
        'text-anchor': right ? 'end' : 'start', class: 'failed'}, p.name + ': ' + p.reason));
      return;
    }
    const x = X(p.figures.ms_p99), y = Y(y_of(p));
    const dot = element('circle', {cx: x, cy: y, r: p.named ? 8 : 6, fill: colour(p),
      class: 'point' + (i === chosen ? ' chosen' : '')});
    dot.onclick = () => choose(i);
    dot.append(element('title', {}, p.name));
    svg.append(dot);
    if (p.named || axis.front.includes(i) || i === chosen)
      svg.append(element('text', {x: x + 9, y: y - 7, class: 'name'}, p.name));
  });
  document.getElementById('chart').replaceChildren(svg);
}

function table() {
  const head = document.createElement('thead'), body = document.createElement('tbody');
  const titles = head.insertRow();
  for (const [key, title] of [['name', 'setting'], ...columns]) {
    const th = document.createElement('th');
    th.textContent = title + (key === sorted ? (rising ? ' \u2191' : ' \u2193') : '');
    th.onclick = () => { rising = key === sorted ? !rising : true; sorted = key; table(); };
    titles.append(th);
  }
  const value = p => sorted === 'name' ? p.name : p.figures[sorted];
  const order = data.points.map((p, i) => i).sort((a, b) => {
    const x = value(data.points[a]), y = value(data.points[b]);
    if (x === undefined || y === undefined) return (x === undefined) - (y === undefined);
    return (x < y ? -1 : x > y ? 1 : 0) * (rising ? 1 : -1);
  });
  for (const i of order) {
    const p = data.points[i], row = body.insertRow();
    row.onclick = () => choose(i);
    if (i === chosen) row.style.fontWeight = 'bold';
    const name = row.insertCell();
    name.textContent = p.name + (p.failed ? ' (' + p.reason + ')' : '');
    if (p.failed) name.className = 'bad';
    for (const [key] of columns) row.insertCell().textContent = short(p.figures[key]);
  }
  document.getElementById('table').replaceChildren(head, body);
}
draw();
table();
)";

} // namespace tutu::app
