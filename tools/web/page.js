/* page.js - the page's thread: controls, pointer, keys, texts. It computes nothing that takes long: worker.js does, and
   sends frames; draw.js draws them. */
'use strict';

const $ = id => document.getElementById(id);

/* The rules in the order of `rule` in page.c: what the page calls them, how the command line and C do. `value` is the weight
   where a slider gives it. */
const rules = [
    {key: 'planar', label: 'Panels are flat', command: '--planar', c: 'gproj_add_planarity(form, 1)'},
    {key: 'circular', label: 'Panels have a circumcircle', command: '--circular', c: 'gproj_add_circularity(form, 1)', needs: 'planar'},
    {key: 'conical', label: 'Nodes are conical', command: '--conical', c: 'gproj_add_conicality(form, 1)', needs: 'planar'},
    {key: 'equalLengths', label: 'Edges are equally long', command: '--equal-lengths',
        c: 'gproj_add_equal_lengths(form, mesh->edge_count, NULL, 1)'},
    {key: 'equilibrium', label: 'Forces balance the weight', command: '--equilibrium --area-load 1',
        c: 'gproj_add_equilibrium(form, &loads, &supports, 1)'},
    {key: 'compression', label: 'Compression only', command: '--compressive', needs: 'equilibrium', excludes: ['tension'],
        c: 'gproj_add_compression(form, mesh->edge_count, NULL, 1)'},
    {key: 'tension', label: 'Tension only', command: '--tensile', needs: 'equilibrium', excludes: ['compression'],
        c: 'gproj_add_tension(form, mesh->edge_count, NULL, 1)'},
    {key: 'fixedBoundary', label: 'Boundary stays', command: '--fix boundary', c: 'gproj_add_fixed_boundary(form, 1)',
        excludes: ['gliding', 'fixedCorners']},
    {key: 'fixedCorners', label: 'Corners stay', command: '--fix corners', c: 'gproj_add_fixed_corners(form, 1)',
        excludes: ['fixedBoundary', 'gliding']},
    {key: 'gliding', label: 'Boundary glides on its curve', command: '--glide boundary', c: 'gproj_add_gliding_boundary(form, 1)',
        excludes: ['fixedBoundary', 'fixedCorners']},
    {key: 'lifting', label: 'Vertices move in height only', command: '--lifting', c: 'gproj_add_lifting(form, 1)'},
    {key: 'fixed'},
    {key: 'fairness', label: 'Fair lines', most: 0.5, command: '--fairness', c: 'gproj_add_fairness'},
    {key: 'closeness', label: 'Near the start', most: 0.5, command: '--closeness', c: 'gproj_add_closeness'},
    {key: 'tangential', label: 'Even panels', most: 0.5, command: '--tangential', c: 'gproj_add_tangential_fairness'},
    {key: 'equalAreas', label: 'Equal areas', most: 0.5, command: '--equal-areas', c: 'gproj_add_equal_areas'},
];
const index = Object.fromEntries(rules.map((r, k) => [r.key, k]));
const CONVERGED = 0, FAILED = 5;

const weights = new Array(rules.length).fill(0);
let drawing = null, worker = null, item = gallery[0].name, activity = 'starting';
let opened = {name: '', text: ''}; // the mesh as it was opened
let mesh = null, marks = null, pins = [], selected = -1, drag = null, named = null, saving = null;
let dirty = true, unseen = false; // a picture is to be drawn; the mesh has not been seen yet

const send = (message, transfer = []) => worker.postMessage(message, transfer);

/* -- words -- */

function say(text, mood, place = null) {
    $('sentence').textContent = text;
    $('verdict').dataset.mood = mood;
    $('verdict').disabled = !place;
    named = place;
}
const capital = text => text.charAt(0).toUpperCase() + text.slice(1) + (/[.!?]$/.test(text) ? '' : '.');

function showState(state) {
    activity = state.activity;
    document.body.dataset.activity = activity;
    const busy = activity === 'solve' || activity === 'release';
    $('stop').disabled = activity === 'none';
    $('undo').disabled = !state.undo;
    $('redo').disabled = !state.redo;
    if (busy && !state.iterations) say('Setting up.', 'busy');
    else if (busy) say(`${activity === 'solve' ? 'Solving' : 'Releasing'}: iteration ${state.iterations}, residual ${state.residual.toExponential(1)}.`, 'busy');
    if (activity === 'drag') {
        const held = state.held ? ' The vertex stays behind: what must hold lets it go no farther.' : '';
        say(`Dragging: what must hold is off by ${state.residual.toExponential(1)} mean edges.${held}`, 'busy');
    }
    document.body.dataset.residual = state.residual;
}

/* -- frames -- */

function paint() {
    if (dirty) {
        dirty = false;
        drawing.draw();
    }
    requestAnimationFrame(paint);
}

/* Bars over the ramp: how many panels, or edges, have which colour. */
function showLegend() {
    const byForce = drawing.byForce, count = 22, bars = new Array(count).fill(0);
    const values = byForce ? drawing.forces : drawing.planarity;
    for (const value of values) {
        const t = byForce ? (value + 1) / 2 : (Math.log10(Math.max(value, 1e-9)) + 4) / 2;
        bars[Math.max(0, Math.min(count - 1, Math.floor(t * count)))]++;
    }
    const most = Math.max(1, ...bars);
    $('bars').innerHTML = bars.map(n => `<i style="height:${n ? 4 + 96 * Math.sqrt(n / most) : 0}%"></i>`).join('');
    $('legend').classList.toggle('forces', byForce);
    $('scale').innerHTML = byForce ? '<span>tension</span><span>compression</span>'
        : '<span>flat</span><span>1 % of an edge</span>';
}

function showPoints() {
    if (!mesh || !marks) return;
    const points = [];
    for (let v = 0; v < mesh.vertices; ++v)
        if (marks[v] & 2 || weights[index.fixedBoundary] && marks[v] & 1 && mesh.vertices < 3000) points.push([v, 1]);
    if (selected >= 0) points.push([selected, 2]);
    drawing.setPoints(points);
    $('fix').disabled = selected < 0;
    $('fix').textContent = selected >= 0 && marks[selected] & 2 ? 'Free vertex' : 'Fix vertex';
    dirty = true;
}

function select(vertex) {
    selected = vertex;
    showPoints();
}

const answers = {
    mesh(message) {
        mesh = message;
        memorySize = message.memory;
        selected = -1;
        weights[index.fixed] = 0;
        drawing.setMesh(mesh);
        unseen = true;
        $('counts').textContent = `${opened.name}: ${mesh.vertices} vertices, ${mesh.faces} panels, ${mesh.edges} edges`;
        say('Nothing has been solved yet.', '');
        document.body.dataset.mesh = opened.name;
    },
    marks(message) {
        marks = message.marks;
        pins = message.pins;
        showPoints();
    },
    frame(state) {
        if (state.buffer) {
            const frame = new Float32Array(state.buffer);
            drawing.setFrame(frame);
            if (unseen) unseen = false, Object.assign(drawing.view, {yaw: -1.05, pitch: 0.5}), fit();
            send({does: 'back', buffer: state.buffer}, [state.buffer]);
            document.body.dataset.frames = Number(document.body.dataset.frames || 0) + 1;
            dirty = true;
            showLegend();
        }
        showState(state);
        if (drag && drag.waiting) drag.waiting = false, follow();
    },
    verdict(message) {
        const good = message.outcome === CONVERGED && !message.spoiled;
        say(capital(message.sentence), good ? 'good' : 'bad', message.named);
        document.body.dataset.verdict = message.sentence;
    },
    told(message) { say(message.sentence, ''); },
    error(message) {
        if (pending) pending = null;
        say(capital(message.sentence), 'bad');
        document.body.dataset.error = message.sentence;
    },
    text(message) {
        if (saving) saving(message.bytes);
        saving = null;
    },
};

/* -- meshes -- */

let memorySize = 0; // of the worker's instance, in bytes
let pending = null; // what is being opened; it becomes `opened` when it is there

function open(name, bytes, preset = null) {
    const text = bytes.slice();
    pending = {name, text};
    if (preset) setWeights(preset);
    send({does: 'open', bytes: bytes.buffer, name, settings: weights.map((w, k) => [k, w])}, [bytes.buffer]);
}
const openText = (name, text, preset) => open(name, new TextEncoder().encode(text), preset);

async function openFile(file) {
    if (!file) return;
    if (file.size > 200e6) return say(`${file.name} has more than 200 MB.`, 'bad');
    item = '';
    open(file.name, new Uint8Array(await file.arrayBuffer()));
}

function choose(name) {
    const chosen = gallery.find(g => g.name === name) || gallery[0];
    item = chosen.name;
    setColour(chosen.colour || 'planarity');
    openText(chosen.name.toLowerCase().replace(/ /g, '_') + '.obj', chosen.make(), chosen.rules);
}

function showItem() {
    for (const button of $('gallery').children) button.setAttribute('aria-pressed', String(button.textContent === item));
    const chosen = gallery.find(g => g.name === item);
    $('hint').textContent = chosen ? chosen.hint : '';
}

function download(name, bytes) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes], {type: 'text/plain'}));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/* The mesh as it is, as OBJ: bytes. */
function writeMesh() {
    return new Promise(resolve => {
        saving = resolve;
        send({does: 'write', off: false});
    });
}

/* -- rules -- */

function setWeights(preset) {
    rules.forEach((r, k) => { weights[k] = r.key === 'fixed' ? weights[k] : preset[r.key] || 0; });
    showRules();
}

function showRules() {
    rules.forEach((r, k) => {
        if (!r.input) return;
        if (r.most) r.input.value = weights[k], r.output.value = weights[k] ? weights[k].toFixed(2) : 'off';
        else r.input.checked = weights[k] > 0;
    });
    const on = rules.filter((r, k) => r.label && weights[k]).map(r => `${r.key}=${weights[index[r.key]]}`).join('&');
    const hash = `${item ? `mesh=${encodeURIComponent(item)}&` : ''}${on}`;
    history.replaceState(null, '', '#' + hash);
}

function setRule(key, weight) {
    const rule = rules[index[key]];
    weights[index[key]] = weight;
    if (weight && rule.needs) weights[index[rule.needs]] ||= 1;
    if (weight) for (const other of rule.excludes || []) weights[index[other]] = 0;
    if (!weight) rules.forEach((r, k) => { if (r.needs === key) weights[k] = 0; });
    if (key === 'equilibrium') setColour(weight ? 'forces' : 'planarity');
    showRules();
    showPoints();
    send({does: 'set', settings: weights.map((w, k) => [k, w])});
}

function setColour(which) {
    drawing.byForce = which === 'forces';
    document.querySelector(`input[name=colour][value=${which}]`).checked = true;
    if (mesh) showLegend();
    dirty = true;
}

/* -- actions -- */

function solve() { send({does: 'solve', iterations: 200}); }
function stop() { drag = null; send({does: 'stop'}); }

function toggleFixed() {
    if (selected < 0) return;
    marks[selected] ^= 2;
    send({does: 'fix', vertex: selected, on: (marks[selected] & 2) !== 0});
    weights[index.fixed] = marks.some(m => m & 2) ? 1 : 0;
    send({does: 'set', settings: weights.map((w, k) => [k, w])});
    showPoints();
}

const reach = () => Number($('reach').value) * mesh.edge;

/* Sends the drag's target, one at a time: the next one when the frame of the last one is there. */
function follow() {
    if (!drag || !drag.target || drag.waiting) return;
    send({does: 'move', to: drag.target});
    drag.target = null;
    drag.waiting = true;
}

function nudge(dx, dy, dz) {
    if (selected < 0 || activity === 'drag') return;
    const {right, up} = drawing.axes(), step = 0.25 * mesh.edge;
    const to = drawing.place(selected).map((p, k) => p + step * (dx * right[k] + dy * up[k] + (k === 2 ? dz : 0)));
    send({does: 'grab', vertex: selected, reach: reach()});
    send({does: 'move', to});
    send({does: 'release'});
}

/* -- the view -- */

/* Shows the whole mesh: the view's axes stay, distance and target follow from where the vertices appear. */
function fit() {
    const {view, canvas} = drawing, {right, up} = drawing.axes();
    Object.assign(view, {distance: 5, target: [0, 0, 0]});
    for (let round = 0; round < 5; ++round) {
        const m = drawing.matrix(), low = [Infinity, Infinity], high = [-Infinity, -Infinity];
        for (let v = 0; v < mesh.vertices; ++v) {
            const p = drawing.project(drawing.place(v), m);
            for (let k = 0; k < 2; ++k) low[k] = Math.min(low[k], p[k]), high[k] = Math.max(high[k], p[k]);
        }
        const size = [canvas.clientWidth, canvas.clientHeight], scale = drawing.pixel(view.distance);
        const off = [0, 1].map(k => scale * ((low[k] + high[k]) / 2 - size[k] / 2));
        view.target = view.target.map((t, k) => t + off[0] * right[k] - off[1] * up[k]);
        view.distance *= Math.max((high[0] - low[0]) / (0.84 * size[0]), (high[1] - low[1]) / (0.74 * size[1]), 0.1);
    }
    dirty = true;
}

function orbit(dx, dy) {
    drawing.view.yaw -= dx;
    drawing.view.pitch = Math.max(-1.55, Math.min(1.55, drawing.view.pitch + dy));
    dirty = true;
}

function zoom(factor) {
    drawing.view.distance = Math.max(0.15, Math.min(40, drawing.view.distance * factor));
    dirty = true;
}

function pan(dx, dy) {
    const {right, up} = drawing.axes(), scale = drawing.pixel(drawing.view.distance), {target} = drawing.view;
    for (let k = 0; k < 3; ++k) target[k] += scale * (-dx * right[k] + dy * up[k]);
    dirty = true;
}

/* Moves the view to a place, in a few pictures. */
function fly(place, count = 18) {
    const {view} = drawing, from = view.target.slice(), distance = view.distance, near = Math.min(distance, 2.2);
    let n = 0;
    const next = () => {
        const t = ++n / count, s = t * t * (3 - 2 * t);
        view.target = from.map((f, k) => f + s * (place[k] - f));
        view.distance = distance + s * (near - distance);
        dirty = true;
        if (n < count) requestAnimationFrame(next);
    };
    next();
}

/* -- pointers: one on a vertex drags it, one elsewhere turns the view, two move and zoom it -- */

function listenToPointers(canvas) {
    const pointers = new Map();
    const at = event => {
        const box = canvas.getBoundingClientRect();
        return [event.clientX - box.left, event.clientY - box.top];
    };
    canvas.addEventListener('pointerdown', event => {
        const [x, y] = at(event);
        canvas.setPointerCapture(event.pointerId);
        canvas.focus({preventScroll: true});
        pointers.set(event.pointerId, {x, y});
        if (pointers.size > 1 || event.button === 2 || event.shiftKey) {
            if (drag) release();
            return;
        }
        const vertex = drawing.pick(x, y, event.pointerType === 'touch');
        select(vertex);
        if (vertex < 0) return;
        const place = drawing.place(vertex), w = drawing.project(place)[2];
        drag = {vertex, x, y, place, scale: drawing.pixel(w), axes: drawing.axes(), begun: false, waiting: false, target: null};
    });
    canvas.addEventListener('pointermove', event => {
        const [x, y] = at(event), before = pointers.get(event.pointerId);
        if (!before) {
            canvas.classList.toggle('handle', drawing.pick(x, y, false) >= 0);
            return;
        }
        const dx = x - before.x, dy = y - before.y;
        if (pointers.size === 2) {
            const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
            zoom(Math.hypot(before.x - other.x, before.y - other.y) / Math.max(1, Math.hypot(x - other.x, y - other.y)));
            pan(dx / 2, dy / 2);
        } else if (drag) {
            pull(x, y, event.altKey);
        } else if (event.buttons === 2 || event.shiftKey) {
            pan(dx, dy);
        } else {
            orbit(0.008 * dx, 0.008 * dy);
        }
        Object.assign(before, {x, y});
    });
    const up = event => {
        pointers.delete(event.pointerId);
        if (drag) release();
    };
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    canvas.addEventListener('wheel', event => {
        event.preventDefault();
        zoom(Math.exp(0.0012 * event.deltaY));
    }, {passive: false});
}

/* The pointer has dragged the vertex to (x, y): in the plane of the screen, with Alt up and down only. */
function pull(x, y, upright) {
    const dx = x - drag.x, dy = y - drag.y, {right, up} = drag.axes;
    if (!drag.begun) {
        if (Math.hypot(dx, dy) < 3) return;
        drag.begun = true;
        $('canvas').classList.add('dragging');
        send({does: 'grab', vertex: drag.vertex, reach: reach()});
    }
    drag.target = drag.place.map((p, k) =>
        p + drag.scale * (upright ? (k === 2 ? -dy : 0) : dx * right[k] - dy * up[k]));
    follow();
}

function release() {
    if (drag.begun) {
        if (drag.target) send({does: 'move', to: drag.target});
        send({does: 'release'});
    }
    drag = null;
    $('canvas').classList.remove('dragging');
}

/* -- keys -- */

const keys = {
    ArrowLeft: () => selected < 0 ? orbit(-0.1, 0) : nudge(-1, 0, 0),
    ArrowRight: () => selected < 0 ? orbit(0.1, 0) : nudge(1, 0, 0),
    ArrowUp: () => selected < 0 ? orbit(0, 0.1) : nudge(0, 1, 0),
    ArrowDown: () => selected < 0 ? orbit(0, -0.1) : nudge(0, -1, 0),
    PageUp: () => nudge(0, 0, 1),
    PageDown: () => nudge(0, 0, -1),
    n: () => mesh && select((selected + 1) % mesh.vertices),
    p: () => mesh && select((selected + mesh.vertices - 1 + (selected < 0)) % mesh.vertices),
    f: toggleFixed,
    s: solve,
    '+': () => zoom(0.9),
    '-': () => zoom(1 / 0.9),
};

function listenToKeys() {
    document.addEventListener('keydown', event => {
        if ($('dialog').open) return;
        if (event.key === 'Escape') {
            if (activity === 'none') select(-1);
            else stop();
        } else if (event.ctrlKey || event.metaKey) {
            const key = event.key.toLowerCase(), back = key === 'z' && !event.shiftKey;
            if (!back && key !== 'y' && key !== 'z') return;
            send({does: back ? 'undo' : 'redo'});
            event.preventDefault();
        } else if (keys[event.key] && (event.target === $('canvas') || event.key === 's')) {
            keys[event.key]();
            event.preventDefault();
        }
    });
}

/* -- the same elsewhere: a program and a command that open the mesh as it was opened here and solve it so -- */

const fixedList = () => pins.filter(pin => !pin[4]).map(pin => pin[0]);
const movedList = () => pins.filter(pin => pin[4]); // fixed, but elsewhere than in the file
const isOn = key => weights[index[key]] > 0;

/* A file's name as a word of the shell, and as a string in C. */
const shellWord = name => /^[\w.+-]+$/.test(name) && name[0] !== '-' ? name : `'./${name.replace(/'/g, "'\\''")}'`;
const cString = name => `"${name.replace(/["\\?]/g, '\\$&')}"`;

function asCommand() {
    const parts = ['tools/guidedproj', shellWord(opened.name), '-o solved.obj'];
    rules.forEach((r, k) => {
        if (weights[k] && r.command) parts.push(r.most ? `${r.command}${r.key === 'equalAreas' ? '=' : ' '}${weights[k]}` : r.command);
    });
    if (fixedList().length) parts.push(`--fix ${fixedList().join(',')}`);
    for (const [vertex, x, y, z] of movedList()) parts.push(`--move ${vertex},${x},${y},${z}`);
    return parts.join(' ') + '\n';
}

function asProgram() {
    const fixed = fixedList(), moved = movedList(), lines = [];
    const out = (...more) => lines.push(...more);
    out('/* Build and run: cc -O2 -I. solve.c -lm -o solve && ./solve */', '#define GUIDEDPROJ_IMPLEMENTATION',
        '#include "guidedproj.h"', '#include <stdio.h>', '#include <stdlib.h>', '', 'int main(void) {',
        '    gproj_error error;', `    gproj_mesh *mesh = gproj_mesh_load(${cString(opened.name)}, NULL, &error);`,
        '    if (!mesh) return puts(error.message), 1;', '    gproj_form *form = gproj_form_create(mesh, NULL);',
        '    gproj_solve_options options = {.smooth = true};');
    if (isOn('equilibrium')) {
        out('    /* Panels weigh 1 per area; the boundary carries. */', '    gproj_loads loads = {.area_load = 1};',
            '    int32_t *boundary = malloc(sizeof *boundary * (size_t)mesh->vertex_count);', '    int32_t count = 0;',
            '    for (int32_t v = 0; v < mesh->vertex_count; ++v)',
            '        if (gproj_mesh_is_boundary_vertex(mesh, v)) boundary[count++] = v;',
            '    gproj_supports supports = {count, boundary, NULL};');
    }
    if (fixed.length) out(`    static const int32_t fixed[] = {${fixed.join(', ')}};`);
    if (moved.length) {
        out(`    static const int32_t moved[] = {${moved.map(pin => pin[0]).join(', ')}};`,
            `    static const double places[] = {${moved.map(pin => pin.slice(1, 4).join(', ')).join(', ')}};`);
    }
    rules.forEach((r, k) => {
        if (!weights[k] || !r.c) return;
        if (!r.most) out(`    ${r.c};`);
        else out(`    gproj_set_schedule(form, ${r.c}(form, 1),`,
            `                       gproj_fade(${weights[k]}, ${isOn('equilibrium') ? 9 : 6}));`);
    });
    if (fixed.length) out(`    gproj_add_fixed(form, ${fixed.length}, fixed, 1);`);
    if (moved.length) out(`    gproj_add_targets(form, ${moved.length}, moved, places, 1);`);
    out('    gproj_result result = gproj_solve(form, 200, &options);', '    puts(result.message);',
        '    if (result.outcome != GPROJ_FAILED) gproj_mesh_save(mesh, "solved.obj", &error);',
        '    gproj_form_destroy(form);', '    gproj_mesh_destroy(mesh);');
    if (isOn('equilibrium')) out('    free(boundary);');
    out('    return result.outcome != GPROJ_CONVERGED;', '}');
    return lines.join('\n') + '\n';
}

function show(title, note, text) {
    $('dialog-title').textContent = title;
    $('dialog-note').textContent = note;
    $('code').textContent = text;
    $('dialog').showModal();
}

/* Copies the text, or, where the browser does not let it, selects it. */
function copy() {
    const told = words => { $('copy').textContent = words; setTimeout(() => { $('copy').textContent = 'Copy'; }, 1500); };
    getSelection().selectAllChildren($('code'));
    (navigator.clipboard?.writeText($('code').textContent) ?? Promise.reject()).then(() => told('Copied'), () => told('Selected'));
}

/* -- beginning -- */

function makeControls() {
    for (const {name} of gallery) {
        const button = document.createElement('button');
        button.textContent = name;
        button.onclick = () => choose(name);
        $('gallery').append(button);
    }
    for (const rule of rules) {
        if (!rule.label) continue;
        const label = document.createElement('label'), input = document.createElement('input'), text = document.createElement('span');
        text.textContent = rule.label;
        rule.input = input;
        if (rule.most) {
            Object.assign(input, {type: 'range', min: 0, max: rule.most, step: 0.01, value: 0});
            rule.output = document.createElement('output');
            label.className = 'slider';
            label.append(text, input, rule.output);
            input.oninput = () => setRule(rule.key, Number(input.value));
        } else {
            input.type = 'checkbox';
            label.className = 'check';
            label.append(input, text);
            input.onchange = () => setRule(rule.key, input.checked ? 1 : 0);
        }
        input.id = 'rule-' + rule.key;
        $(rule.most ? 'wishes' : 'holds').append(label);
    }
    $('solve').onclick = solve;
    $('stop').onclick = stop;
    $('undo').onclick = () => send({does: 'undo'});
    $('redo').onclick = () => send({does: 'redo'});
    $('verdict').onclick = () => named && fly(named);
    $('open').onclick = () => $('file').click();
    $('file').onchange = event => { openFile(event.target.files[0]); event.target.value = ''; };
    $('save').onclick = async () => download(opened.name.replace(/\.\w+$/, '') + '_solved.obj', await writeMesh());
    $('fix').onclick = toggleFixed;
    $('fit').onclick = fit;
    $('reach').oninput = () => { $('reach-value').value = Number($('reach').value) ? `${$('reach').value}` : 'off'; };
    $('reach').oninput();
    for (const input of document.querySelectorAll('input[name=colour]')) input.onchange = () => setColour(input.value);
    $('as-c').onclick = () => show('As C', `Opens ${opened.name}, the mesh as it was opened here, and solves it so.`, asProgram());
    $('as-command').onclick = () => show('As a command', `Opens ${opened.name}, the mesh as it was opened here, and solves it so.`, asCommand());
    $('copy').onclick = copy;
    $('save-opened').onclick = () => download(opened.name, opened.text);
    $('close').onclick = () => $('dialog').close();
}

function listenToDrops(stage) {
    const over = on => event => {
        event.preventDefault();
        stage.classList.toggle('over', on);
    };
    stage.addEventListener('dragover', over(true));
    stage.addEventListener('dragleave', over(false));
    stage.addEventListener('drop', event => {
        over(false)(event);
        openFile(event.dataTransfer.files[0]);
    });
}

/* The module, from base64 and gzip. */
async function unpack() {
    const packed = Uint8Array.from(atob($('wasm').textContent), c => c.charCodeAt(0));
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

async function begin() {
    makeControls();
    drawing = new Drawing($('canvas'));
    worker = new Worker(URL.createObjectURL(new Blob([$('worker').textContent], {type: 'text/javascript'})));
    worker.onmessage = ({data}) => {
        if (data.is === 'mesh' && pending) opened = pending, pending = null, showItem();
        answers[data.is](data);
    };
    worker.onerror = event => say(`The worker failed: ${event.message}`, 'bad');
    const bytes = await unpack();
    send({does: 'start', bytes}, [bytes]);
    listenToPointers($('canvas'));
    listenToKeys();
    listenToDrops($('stage'));
    new ResizeObserver(() => { dirty = true; }).observe($('canvas'));
    const wanted = new URLSearchParams(location.hash.slice(1));
    choose(wanted.get('mesh'));
    if (wanted.get('mesh')) {
        const preset = {};
        for (const [key, weight] of wanted) if (key in index) preset[key] = Math.max(0, Math.min(1, Number(weight) || 0));
        setWeights(preset);
        send({does: 'set', settings: weights.map((w, k) => [k, w])});
    }
    paint();
}
begin().catch(error => say(capital(error.message), 'bad'));
