/* worker.js - one worker with one instance of page.c. The page sends messages {does: name, ...}; answers are {is: name, ...}.
   Frames travel in buffers that the page gives back. A solve runs in pieces of a few milliseconds, so that messages get
   through; what is undone lies here as snapshots. */
'use strict';

const REFUSED = 0, ON_THE_WAY = 2; // see page_move
const FRAME_SECONDS = 0.012, UNDO_BYTES = 1 << 28;
let module = null, wasm = null;
let opened = null;               // {text, settings, snapshot, fixed}: what a new instance goes on from
let activity = 'none';           // 'none', 'drag', 'release' or 'solve'
let target = null, armed = false; // of a drag; is a turn of work under way?
let frameSize = 0, spare = [];   // of a frame in bytes; frame buffers that are at home
let undo = [], redo = [];
const channel = new MessageChannel(), decoder = new TextDecoder();

const bytes = (at, length) => new Uint8Array(wasm.memory.buffer, at, length);
function textAt(at) {
    const all = new Uint8Array(wasm.memory.buffer);
    return decoder.decode(all.subarray(at, all.indexOf(0, at)));
}
const sentence = () => textAt(wasm.page_sentence());

function instantiate() {
    const imports = {page: {now: () => performance.now() / 1000}};
    for (const {module: from, name} of WebAssembly.Module.imports(module)) // what the C library would ask of a system
        if (from !== 'page') (imports[from] ||= {})[name] = () => { throw new Error(name); };
    wasm = new WebAssembly.Instance(module, imports).exports;
    wasm.__wasm_call_ctors();
}

/* Copies `data` (bytes) into the block; false: no memory. */
function give(data) {
    const at = wasm.page_block(data.length || 1);
    if (at) bytes(at, data.length).set(data);
    return at !== 0;
}

/* -- what the page sees -- */

function postFrame() {
    const state = {
        is: 'frame', activity, undo: undo.length, redo: redo.length, outcome: wasm.page_outcome(),
        iterations: wasm.page_iterations(), residual: wasm.page_residual(), spoiled: wasm.page_spoiled(),
        held: activity === 'drag' && wasm.page_held() !== 0, buffer: null,
    };
    if (spare.length > 0 && wasm.page_frame()) {
        state.buffer = spare.pop();
        new Uint8Array(state.buffer).set(bytes(wasm.page_block(0), frameSize));
    } else if (activity === 'none') {
        setTimeout(() => guarded(postFrame), 5); // the last frame must arrive
        return;
    }
    postMessage(state, state.buffer ? [state.buffer] : []);
}

function setFrames(size) {
    frameSize = size;
    spare = [new ArrayBuffer(size), new ArrayBuffer(size)];
}

function postVerdict() {
    const named = wasm.page_named() ? Array.from(new Float64Array(wasm.memory.buffer, wasm.page_block(0), 3)) : null;
    postMessage({is: 'verdict', sentence: sentence(), outcome: wasm.page_outcome(), spoiled: wasm.page_spoiled(), named});
}

function postMesh(name) {
    const vertices = wasm.page_vertices(), faces = wasm.page_faces(), edges = wasm.page_edges();
    const triangles = wasm.page_topology(), at = wasm.page_block(0);
    const corners = new Uint32Array(wasm.memory.buffer.slice(at, at + 24 * triangles));
    const ends = new Uint32Array(wasm.memory.buffer.slice(at + 24 * triangles, at + 24 * triangles + 8 * edges));
    setFrames(4 * (4 * vertices + faces + edges));
    postMessage({is: 'mesh', name, vertices, faces, edges, corners, ends, edge: wasm.page_reach(1),
        memory: wasm.memory.buffer.byteLength});
    postMarks();
}

function postMarks() {
    if (!wasm.page_marks()) return;
    const marks = bytes(wasm.page_block(0), wasm.page_vertices()).slice(), count = wasm.page_pins();
    const pins = Array.from({length: count}, (_, k) => Array.from(new Float64Array(wasm.memory.buffer, wasm.page_block(0) + 40 * k, 5)));
    postMessage({is: 'marks', marks, pins});
}

/* -- undo -- */

function snapshot() {
    const count = wasm.page_snapshot();
    return new Float64Array(wasm.memory.buffer.slice(wasm.page_block(0), wasm.page_block(0) + 8 * count));
}
function restore(data) {
    if (give(new Uint8Array(data.buffer))) wasm.page_restore();
}
function remember() {
    undo.push(snapshot());
    redo = [];
    while (undo.length > 1 && undo.length * undo[0].byteLength > UNDO_BYTES) undo.shift();
}
function exchange(from, to) {
    finish();
    if (from.length === 0) return;
    to.push(snapshot());
    restore(from.pop());
    opened.snapshot = snapshot();
    postFrame();
    postMessage({is: 'told', sentence: from === undo ? 'Undone.' : 'Done again.'});
}

/* -- work in turns -- */

function arm() {
    if (armed) return;
    armed = true;
    channel.port2.postMessage(0);
}

/* Ends what is on: a release is taken to its end, a solve stays where it is. */
function finish() {
    if (activity === 'drag') wasm.page_release();
    if (activity === 'drag' || activity === 'release') while (wasm.page_step(0.1)) continue;
    if (activity === 'solve') wasm.page_stop();
    if (activity !== 'none') settle();
}

function settle() {
    activity = 'none';
    target = null;
    opened.snapshot = snapshot();
}

function turn() {
    armed = false;
    if (activity === 'drag') {
        if (!target) return;
        const moved = wasm.page_move(...target);
        if (moved === REFUSED) postMessage({is: 'error', sentence: sentence()});
        if (moved === ON_THE_WAY) arm();
        else target = null;
        postFrame();
    } else if (activity === 'solve' || activity === 'release') {
        const more = wasm.page_step(FRAME_SECONDS);
        if (!more) {
            settle();
            postVerdict();
        }
        postFrame();
        if (more) arm();
    }
}

const does = {
    start({bytes}) {
        module = new WebAssembly.Module(bytes);
        instantiate();
    },
    open({bytes, name, settings}) {
        if (!give(new Uint8Array(bytes))) return postMessage({is: 'error', sentence: 'there is not enough memory'});
        if (!wasm.page_open(bytes.byteLength))
            return postMessage({is: 'error', sentence: `The file ${name} was not opened: ${sentence()}`});
        activity = 'none', undo = [], redo = [];
        opened = {text: bytes, settings: opened?.settings ?? [], fixed: new Set()};
        if (settings) does.set({settings});
        opened.snapshot = snapshot();
        postMesh(name);
        postFrame();
    },
    set({settings}) {
        for (const [which, weight] of settings) wasm.page_set(which, weight);
        if (opened) opened.settings = settings;
    },
    fix({vertex, on}) {
        wasm.page_fix(vertex, on);
        if (on) opened.fixed.add(vertex);
        else opened.fixed.delete(vertex);
        postMarks();
    },
    solve({iterations}) {
        finish();
        remember();
        if (!wasm.page_solve(iterations)) {
            undo.pop();
            postMessage({is: 'error', sentence: sentence()});
            return postFrame();
        }
        activity = 'solve';
        postFrame(); // the first turn may take long: it analyses
        arm();
    },
    grab({vertex, reach}) {
        finish();
        remember();
        if (!wasm.page_grab(vertex, reach)) {
            undo.pop();
            postMessage({is: 'error', sentence: sentence()});
            return postFrame();
        }
        activity = 'drag';
    },
    move({to}) {
        if (activity !== 'drag') return;
        target = to;
        arm();
    },
    release() {
        if (activity !== 'drag') return;
        for (let k = 0; target && k < 20; ++k) turn();
        wasm.page_release();
        activity = 'release';
        arm();
    },
    stop() {
        if (activity === 'none') return;
        const drag = activity !== 'solve';
        wasm.page_stop();
        if (drag) undo.pop();
        settle();
        postFrame();
        postMessage({is: 'told', sentence: drag ? 'The drag was taken back.' : 'Stopped: the mesh is as the last iteration left it.'});
    },
    undo() { exchange(undo, redo); },
    redo() { exchange(redo, undo); },
    write({off}) {
        const size = wasm.page_write(off);
        postMessage({is: 'text', off, bytes: bytes(wasm.page_block(0), size).slice()});
    },
    back({buffer}) {
        if (buffer.byteLength === frameSize) spare.push(buffer);
    },
};

/* After a trap, as when memory has run out, a new instance goes on from the last state that was settled. */
function recover(error) {
    postMessage({is: 'error', sentence: `The work broke off (${error.message}) and went back to where it began.`});
    activity = 'none', target = null;
    if (!opened) return;
    instantiate();
    does.set({settings: opened.settings});
    if (!give(new Uint8Array(opened.text)) || !wasm.page_open(opened.text.byteLength)) return;
    restore(opened.snapshot);
    for (const vertex of opened.fixed) wasm.page_fix(vertex, true);
    setFrames(frameSize);
    postMarks();
    postFrame();
}
function guarded(work) {
    try {
        work();
    } catch (error) {
        recover(error);
    }
}
channel.port1.onmessage = () => guarded(turn);
onmessage = ({data}) => guarded(() => does[data.does](data));
