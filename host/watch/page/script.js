// The page of `solidcast watch --serve`. It asks /state again and again, each time for something newer than it knows; the
// answer comes when there is something. Everything else follows from the state.
'use strict';

const at = (id) => document.getElementById(id);
const stage = at('stage');
const images = { gpu: at('gpu'), cpu: at('cpu'), difference: at('difference') };
const phases = [['read', 'Scene and meshes'], ['prepare', 'Records, shaders'], ['cast', 'Rays'], ['write', 'Image file']];
let state = {};
let show = 'gpu';
let pixel = null;  // that is explained
const shown = {};  // frame that each image shows

function element(tag, text, className) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

function row(cells, tag = 'td') {
  const line = element('tr');
  for (const [text, className] of cells) {
    const cell = element(tag, undefined, className);
    cell.append(text ?? '');
    line.append(cell);
  }
  return line;
}

const ms = (value) => value.toFixed(1) + ' ms';

// --- pictures ------------------------------------------------------------------------------------------------------

const comparing = () => show !== 'gpu';
const compared = () => state.comparison && state.frame && state.comparison.frame === state.frame.number && !state.comparison.fault;

async function load(name, frame) {
  if (shown[name] === frame) return;
  shown[name] = frame;
  const next = new Image();
  next.src = `${name}.png?frame=${frame}`;
  try {
    await next.decode();
  } catch {
    if (shown[name] === frame) shown[name] = undefined;
    return;
  }
  if (shown[name] === frame) {
    images[name].src = next.src;
    images[name].dataset.frame = frame;
  }
}

function drawPictures() {
  if (!state.frame) return;
  stage.style.setProperty('--shape', state.frame.width / state.frame.height);
  stage.classList.toggle('large', stage.clientWidth >= 2 * state.frame.width);
  load('gpu', state.frame.number);
  if (comparing() && compared()) {
    load('cpu', state.frame.number);
    load('difference', state.frame.number);
  }
  const ready = compared();
  images.cpu.hidden = !(ready && (show === 'cpu' || show === 'split'));
  images.difference.hidden = !(ready && show === 'difference');
  at('sliderRow').hidden = at('edge').hidden = show !== 'split';
  const part = at('slider').value / 10;
  images.cpu.style.clipPath = show === 'split' ? `inset(0 0 0 ${part}%)` : '';
  at('edge').style.left = part + '%';
  const waiting = comparing() && !ready;
  at('waiting').hidden = !waiting;
  at('waiting').textContent = state.comparison?.fault && state.comparison.frame === state.frame.number
    ? state.comparison.fault : 'The CPU reference is at work; this is the GPU.';
  at('legend').hidden = !(comparing() && ready);
  if (ready) {
    const c = state.comparison;
    const parts = ['Every pixel is the same.'];
    if (c.differing_pixels > 0) {
      const worst = element('button', c.worst_pixel.join(', '));
      worst.type = 'button';
      worst.title = 'Explain this pixel';
      worst.addEventListener('click', () => explain(...c.worst_pixel));
      parts.splice(0, 1, `${c.differing_pixels} pixels differ, by ${c.largest_levels} of 255 levels at most, at `, worst, '.');
    }
    at('legend').replaceChildren(...parts, ` The reference took ${ms(c.reference_ms)}.`);
  }
}

// --- state ---------------------------------------------------------------------------------------------------------

function drawPhases() {
  const frame = state.frame;
  if (!frame) return;
  const values = phases.map(([name]) => frame[name + '_ms']);
  const whole = values.reduce((a, b) => a + b, 0);
  at('bar').replaceChildren(...values.map((value, i) => {
    const part = element('span', undefined, 'p' + i);
    part.style.width = (100 * value / whole) + '%';
    return part;
  }));
  const lines = phases.map(([, label], i) => {
    const name = element('span');
    name.append(element('i', undefined, 'p' + i), label);
    return row([[name], [ms(values[i]), 'n']]);
  });
  lines.push(row([['Whole'], [ms(whole), 'n']]), row([['of rays on the device'], [ms(frame.dispatch_ms), 'n']], 'th'),
    row([['pipelines made'], [String(frame.pipelines_made), 'n']], 'th'),
    row([['size, solids'], [`${frame.width} × ${frame.height}, ${frame.solids}`, 'n']], 'th'));
  at('phases').replaceChildren(...lines);
}

function drawProblems() {
  const parts = [];
  for (const p of state.problems ?? []) {
    const place = [p.file, p.line || '', p.column || ''].filter((x) => x !== '').join(':');
    parts.push(element('p', (place ? place + ': ' : '') + p.message));
    if (!p.source) continue;
    const source = element('pre');
    source.append(element('span', p.line + ' | ', 'number'), p.source);
    if (p.column) source.append('\n', ' '.repeat(String(p.line).length + 2 + p.column) + '^');
    parts.push(source);
  }
  for (const warning of state.warnings ?? []) parts.push(element('p', warning, 'warning'));
  at('problems').hidden = parts.length === 0;
  at('problems').replaceChildren(...parts);
}

function drawChoices() {
  at('scene').textContent = state.scene ?? '';
  document.title = (state.problems?.length ? '✗ ' : '') + (state.scene ?? 'watch') + ' - solidcast';
  at('method').value = state.method;
  const select = at('integrator');
  select.replaceChildren(...(state.integrators ?? []).map((name) => element('option', name)));
  select.value = state.integrator;
  at('reset').disabled = !state.camera_moved;
}

function say(text, bad) {
  at('status').textContent = text;
  at('status').className = bad ? 'bad' : '';
}

function draw() {
  drawPictures();
  drawPhases();
  drawProblems();
  drawChoices();
  const bad = state.problems?.length > 0;
  say(bad ? 'last good image' : state.frame ? `image ${state.frame.number}` : 'no image yet', bad);
}

async function follow() {
  for (;;) {
    try {
      const answer = await fetch(`state?after=${state.version ?? -1}&compare=${comparing() ? 1 : 0}`);
      if (!answer.ok) throw new Error(answer.status);
      const before = state.version;
      state = await answer.json();
      draw();
      if (state.version === before) await new Promise((done) => setTimeout(done, 250));
    } catch {
      say('the watch does not answer', true);
      await new Promise((done) => setTimeout(done, 1000));
    }
  }
}

// --- wishes --------------------------------------------------------------------------------------------------------

async function post(path, wish) {
  const answer = await fetch(path, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(wish) });
  if (!answer.ok) say((await answer.json()).error, true);
}

// Moves are sent one at a time; those that come meanwhile are added up.
const pending = { orbit: [0, 0], pan: [0, 0], zoom: 1 };
let sending = false;
async function move(kind, value) {
  if (kind === 'zoom') pending.zoom *= value;
  else pending[kind] = pending[kind].map((old, i) => old + value[i]);
  if (sending) return;
  sending = true;
  try {
    for (let more = true; more;) {
      more = false;
      for (const name of ['orbit', 'pan', 'zoom']) {
        const wish = pending[name];
        if (name === 'zoom' ? wish === 1 : wish[0] === 0 && wish[1] === 0) continue;
        pending[name] = name === 'zoom' ? 1 : [0, 0];
        const limit = (x, most) => Math.max(-most, Math.min(most, x));
        await post('camera', { [name]: name === 'zoom' ? Math.max(1 / 16, Math.min(16, wish)) : wish.map((x) => limit(x, name === 'pan' ? 4 : 360)) });
        more = true;
      }
    }
  } finally {
    sending = false;
  }
}

function choose(name) {
  show = name;
  document.querySelector(`input[name=show][value=${name}]`).checked = true;
  if (comparing()) fetch('state?compare=1');
  drawPictures();
}

let drag = null;
stage.addEventListener('pointerdown', (event) => {
  drag = { x: event.clientX, y: event.clientY, far: false, pan: event.shiftKey || event.button !== 0 };
  stage.setPointerCapture(event.pointerId);
});
stage.addEventListener('pointermove', (event) => {
  if (!drag) return;
  const dx = event.clientX - drag.x, dy = event.clientY - drag.y;
  if (!drag.far && Math.hypot(dx, dy) < 4) return;
  Object.assign(drag, { x: event.clientX, y: event.clientY, far: true });
  const box = stage.getBoundingClientRect();
  if (drag.pan) move('pan', [dx / box.width, -dy / box.height]);
  else move('orbit', [-180 * dx / box.width, -120 * dy / box.height]);
});
stage.addEventListener('pointerup', (event) => {
  if (drag && !drag.far && event.button === 0) {
    const box = images.gpu.getBoundingClientRect();
    const place = (share, count) => Math.max(0, Math.min(count - 1, Math.floor(share * count)));
    explain(place((event.clientX - box.left) / box.width, state.frame.width), place((event.clientY - box.top) / box.height, state.frame.height));
  }
  drag = null;
});
stage.addEventListener('pointercancel', () => { drag = null; });
stage.addEventListener('contextmenu', (event) => event.preventDefault());
stage.addEventListener('wheel', (event) => {
  event.preventDefault();
  move('zoom', Math.exp(Math.max(-240, Math.min(240, event.deltaY)) / 600));
}, { passive: false });

const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches('input, select, button, summary')) return;
  if (steps[event.key]) {
    const [x, y] = steps[event.key];
    if (event.shiftKey) move('pan', [-0.04 * x, -0.04 * y]);
    else move('orbit', [5 * x, -5 * y]);
  } else if (event.key === '+' || event.key === '=') move('zoom', 0.9);
  else if (event.key === '-') move('zoom', 1 / 0.9);
  else if (event.key === 'r' || event.key === 'R') post('camera', { reset: true });
  else if (event.key === 'p' || event.key === 'P') at('px').focus();
  else if ('1234'.includes(event.key)) choose(['gpu', 'cpu', 'split', 'difference'][event.key - 1]);
  else return;
  event.preventDefault();
});

at('show').addEventListener('change', (event) => choose(event.target.value));
at('slider').addEventListener('input', drawPictures);
at('method').addEventListener('change', (event) => post('view', { method: event.target.value }));
at('integrator').addEventListener('change', (event) => post('view', { integrator: event.target.value }));
at('reset').addEventListener('click', () => post('camera', { reset: true }));
at('copy').addEventListener('click', async () => {
  const text = '"camera": ' + (await (await fetch('camera')).text()).trim();
  try {
    await navigator.clipboard.writeText(text);
    say('camera copied', false);
  } catch {
    window.prompt('The camera, for the scene file:', text);
  }
});

// --- pixel ---------------------------------------------------------------------------------------------------------

function verdictRow(name, verdict) {
  const colour = element('span', undefined, 'swatch');
  colour.style.background = `rgb(${verdict.rgb_levels.join(' ')})`;
  const solid = element('span');
  solid.append(colour, verdict.solid ?? 'nothing');
  const error = verdict.fault ? 'wrong' : verdict.t === null ? '' : verdict.t_error_ulp.toPrecision(2) + ' ulp';
  return row([[name], [solid], [verdict.t_decimal?.slice(0, 14) ?? '', 'n'], [error, verdict.right ? 'n' : 'n wrong']]);
}

function candidatePart(c, i) {
  const part = element('details');
  part.open = i === 0;
  const d = c.decisive;
  part.append(element('summary', `${c.solid}: ${c.hit ? 't = ' + Number(c.t).toPrecision(9) : 'missed'}` +
    (c.hit === c.hit_true ? '' : c.hit_true ? ', in truth hit' : ', in truth missed')));
  if (d) {
    const margin = d.margin === null ? 'no bound' : `${d.margin.toPrecision(3)} times its bound` + (d.margin < 1 ? ': in doubt' : '');
    part.append(element('p', `${d.name} = ${d.shader} (true ${d.true}), ${margin}`, d.wrong_sign ? 'wrong' : ''));
  }
  if (c.lost) part.append(element('p', c.lost));
  if (c.stages) {
    const table = element('table');
    table.append(row([['stage'], ['bits right', 'n'], ['lost here', 'n'], ['by']], 'th'),
      ...c.stages.map((s) => row([[s.name, 'text'], [s.right_bits.toFixed(1), 'n'], [s.lost_here_bits.toFixed(1), 'n'], [s.most_by]])));
    part.append(table);
  }
  return part;
}

function drawPixel(e) {
  const verdicts = element('table');
  verdicts.append(row([[''], ['solid'], ['t', 'n'], ['error', 'n']], 'th'), verdictRow('GPU', e.gpu), verdictRow('CPU', e.cpu),
    verdictRow('truth', e.truth));
  const ray = element('details');
  ray.append(element('summary', 'Ray'), element('p', 'origin ' + e.ray.origin_hex.join(' '), 'hex'),
    element('p', 'direction ' + e.ray.direction_hex.join(' '), 'hex'),
    element('p', 'shader sees ' + e.ray.shader_direction_hex.join(' '), 'hex'));
  const notes = [`Method ${e.method} in ${e.arithmetic}; truth by ${e.truth.decided_by}.`];
  if (e.second_pass) notes.push('Cast again in binary128: ' + e.doubts.join('; ') + '.');
  if (e.truth.tie) notes.push('Another solid has exactly the same t.');
  if (e.candidates_left_out) notes.push(`${e.candidates_left_out} further candidates.`);
  if (e.solids_missed_by_far) notes.push(`${e.solids_missed_by_far} solids missed by far.`);
  const right = e.gpu.right && e.cpu.right;
  at('pixel').replaceChildren(element('p', `(${e.x_px}, ${e.y_px}) ${e.conclusion}`, 'verdict' + (right ? '' : ' wrong')), verdicts,
    ray, ...e.candidates.map(candidatePart), element('p', notes.join(' '), 'hint'));
}

async function explain(x, y) {
  pixel = [x, y];
  at('px').value = x;
  at('py').value = y;
  drawCross();
  const answer = await fetch(`pixel?x=${x}&y=${y}`);
  const explanation = await answer.json();
  if (pixel[0] !== x || pixel[1] !== y) return;
  if (answer.ok) drawPixel(explanation);
  else at('pixel').replaceChildren(element('p', explanation.error, 'wrong'));
}

function drawCross() {
  at('cross').hidden = !pixel || !state.frame;
  if (at('cross').hidden) return;
  at('cross').style.left = 100 * (pixel[0] + 0.5) / state.frame.width + '%';
  at('cross').style.top = 100 * (pixel[1] + 0.5) / state.frame.height + '%';
}

at('pixelForm').addEventListener('submit', (event) => {
  event.preventDefault();
  explain(Math.round(at('px').value), Math.round(at('py').value));
});

follow();
