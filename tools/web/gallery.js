/* gallery.js - meshes to begin with, made by formulas, as OBJ texts. Each has rules that are set when it is opened, and
   a sentence that says what to try. An item may say more: `fix` tells by number and place which vertices are fixed; a
   text without faces is a curve, which is filled with quads from `corners` corners; `levels` subdivides, and `lift`
   lifts. */
'use strict';

const {sin, cos, PI, round, sqrt, hypot} = Math;

const textOf = (points, faces) =>
    points.map(p => 'v ' + p.join(' ')).concat(faces.map(f => 'f ' + f.map(v => v + 1).join(' '))).join('\n') + '\n';

/* Quads in rows and columns: place(s, t), s and t in 0..1; `ring`: the last column meets the first. */
function grid(rows, columns, place, ring = false) {
    const across = ring ? columns : columns + 1, points = [], faces = [];
    for (let i = 0; i <= rows; ++i)
        for (let j = 0; j < across; ++j) points.push(place(i / rows, j / columns, i, j));
    for (let i = 0; i < rows; ++i)
        for (let j = 0; j < columns; ++j) {
            const a = i * across + j, b = i * across + (j + 1) % across;
            faces.push([a, a + across, b + across, b]);
        }
    return textOf(points, faces);
}

/* Collects polygons whose corners are points of a lattice; at(key, place) gives each its number. */
function collect(make) {
    const points = [], faces = [], numbers = new Map();
    make((key, place) => {
        if (!numbers.has(key)) numbers.set(key, points.push(place()) - 1);
        return numbers.get(key);
    }, faces);
    return textOf(points, faces);
}

/* Hexagons in offset rows over the unit square: place(x, y) bends them. Half hexagons stay out. */
const honeycomb = (rows, columns, place) => collect((at, faces) => {
    for (let j = 0; j < columns; ++j)
        for (let i = 0; i < rows; ++i) {
            const x = 1.5 * j + 1, y = 2 * i + 1 + j % 2;
            faces.push([[1, 0], [0.5, 1], [-0.5, 1], [-1, 0], [-0.5, -1], [0.5, -1]].map(
                ([dx, dy]) => at(`${round(6 * (x + dx))},${round(6 * (y + dy))}`,
                    () => place((x + dx) / (1.5 * columns), (y + dy) / (2 * rows)))));
        }
});

/* A closed curve of `count` points. */
const curve = (count, place) =>
    Array.from({length: count}, (_, k) => 'v ' + place(2 * PI * k / count).join(' ')).join('\n') +
    `\nl ${Array.from({length: count}, (_, k) => k + 1).join(' ')} 1\n`;

/* Hexagons like bricks around an oval dome with an opening (Figure 6). */
function dome(around, rings) {
    const points = [], faces = [], inner = around / 2;
    const number = (j, i) =>
        j === 0 ? i % around / 2 : inner + (j - 1) * around + (j === rings ? i % around / 2 : i % around);
    for (let j = 0; j <= rings; ++j)
        for (let i = 0; i < around; i += j % rings ? 1 : 2) {
            const up = 0.1 + 1.1 * (j + (j % rings ? (i + j) % 2 ? -0.17 : 0.17 : 0)) / rings,
                  turn = 2 * PI * i / around;
            points.push([12 * cos(up) * cos(turn), 9 * cos(up) * sin(turn), 7 * (sin(up) - sin(0.1))]);
        }
    for (let j = 0; j < rings; ++j)
        for (let i = j % 2; i < around; i += 2) {
            const below = j ? [0, 1, 2] : [0, 2], above = j < rings - 1 ? [2, 1, 0] : [2, 0];
            faces.push([...below.map(k => number(j, i + k)), ...above.map(k => number(j + 1, i + k))]);
        }
    return textOf(points, faces);
}

/* The faces between cells inside and outside: a nave, wings, and a tower where they meet (Figure 5). */
function blocks() {
    const inside = ([x, y, z]) => {
        const nave = y >= 3 && y < 6, wing = x >= 5 && x < 8;
        return x >= 0 && x < 11 && y >= 0 && y < 9 && z >= 0 && z < (nave && wing ? 6 : nave || wing ? 3 : 0);
    };
    return collect((at, faces) => {
        for (let k = 0; k < 11 * 9 * 6; ++k) {
            const cell = [k % 11, Math.floor(k / 11) % 9, Math.floor(k / 99)];
            if (inside(cell)) for (let side = 0; side < 6; ++side) {
                const a = side >> 1, b = (a + 1) % 3, c = (a + 2) % 3, up = side & 1, next = cell.slice();
                next[a] += up ? 1 : -1;
                if (inside(next)) continue;
                faces.push([0, 1, 2, 3].map(turn => {
                    const node = cell.slice(), t = up ? turn : 3 - turn;
                    node[a] += up, node[b] += Number(t === 1 || t === 2), node[c] += Number(t >= 2);
                    return at(String(node), () => node);
                }));
            }
        }
    });
}

/* Diamonds over a rectangle, triangles where walls cut them (Figure 7). */
const diamonds = (side, place) => collect((at, faces) => {
    for (let i = 0; i <= side; ++i)
        for (let j = 0; j <= side; ++j) {
            const around = [[i + 1, j], [i, j + 1], [i - 1, j], [i, j - 1]]
                .filter(([a, b]) => a >= 0 && b >= 0 && a <= side && b <= side);
            if ((i + j) % 2)
                faces.push(around.map(([a, b]) => at(`${a},${b}`, () => place(2 * a / side - 1, 2 * b / side - 1))));
        }
});

/* A canopy of five sectors of side x side quads on five feet (Figure 8). */
const sectors = (feet, side) => collect((at, faces) => {
    const vertex = (s, a, b) => {
        if (a === 0 && b > 0) return vertex(s + 1, b, 0);
        return at(a === 0 ? 'middle' : `${s % feet},${a},${b}`, () => {
            const turn = 2 * PI / feet, bend = 1 - 0.27 * a * b / (side * side);
            const x = bend * (a * cos(turn * s) + b * cos(turn * (s + 1))),
                  y = bend * (a * sin(turn * s) + b * sin(turn * (s + 1)));
            return [x, y, 7 * side / 12 * (1 - (x * x + y * y) / (1.5 * side * side))];
        });
    };
    for (let k = 0; k < feet * side * side; ++k) {
        const s = Math.floor(k / (side * side)), a = Math.floor(k / side) % side, b = k % side;
        faces.push([vertex(s, a, b), vertex(s, a + 1, b), vertex(s, a + 1, b + 1), vertex(s, a, b + 1)]);
    }
});

/* A waved carpet of quads and triangles with noise (Figure 3). */
function carpet(long, wide) {
    const points = [], faces = [];
    let noise = 1;
    for (let i = 0; i <= long; ++i)
        for (let j = 0; j <= wide; ++j) {
            noise = (Math.imul(noise, 1664525) + 1013904223) >>> 0;
            const bump = i && j && i < long && j < wide ? noise / 4294967296 - 0.5 : 0;
            points.push([i, j, 1.4 * sin(0.3 * i) - 0.06 * (j - 7) ** 2 + 0.3 * sin(0.1 * i * j / wide) + 0.6 * bump]);
        }
    for (let i = 0; i < long; ++i)
        for (let j = 0; j < wide; ++j) {
            const a = i * (wide + 1) + j, [b, c, d] = [a + wide + 1, a + wide + 2, a + 1];
            faces.push(...i % 3 === 1 ? [[a, b, c], [c, d, a]] : [[a, b, c, d]]);
        }
    return textOf(points, faces);
}

/* A horn of triangles that bends over (Figure 12). */
function horn(around, along) {
    const points = [], faces = [];
    for (let i = 0; i <= along; ++i)
        for (let j = 0; j < around; ++j) {
            const t = i / along, bend = 0.44 * PI * t, radius = 1.35 + 1.8 * (t - 0.5) ** 2;
            const turn = 2 * PI * (j + 0.5 * (i % 2)) / around, out = 3.1 - radius * cos(turn);
            points.push([-out * cos(bend), radius * sin(turn), out * sin(bend)]);
        }
    for (let i = 0; i < along; ++i)
        for (let j = 0; j < around; ++j) {
            const k = (j + 1) % around, before = (j + around - 1) % around, a = i * around, b = a + around, odd = i % 2;
            faces.push([a + j, b + (odd ? k : j), b + (odd ? j : before)], [a + j, a + k, b + (odd ? k : j)]);
        }
    return textOf(points, faces);
}

/* A vaulted hall along a bent street (Section 3.5). */
function hall(long, wide) {
    const street = [[0, 0, 0]];
    for (let k = 0; k < long; ++k) {
        const [x, y, turn] = street[k];
        street.push([x + cos(turn), y + sin(turn), turn + 0.1 * sin(0.2 * k)]);
    }
    return grid(long, wide, (s, t, i, j) => {
        const [x, y, turn] = street[i], angle = 2.4 * t - 1.2, ripple = 1 + 0.03 * sin(0.8 * i + 0.9 * j);
        return [
            x - 5 * ripple * sin(angle) * sin(turn), y + 5 * ripple * sin(angle) * cos(turn), 4 * ripple * cos(angle)
        ];
    });
}

/* A funnel of revolution, inverted in a sphere and dented (Section 3.5). */
const funnel = () => grid(10, 26, (s, t, i, j) => {
    const z = 0.56 * i, r = 1.2 + 0.08 * z * z + 0.06 * sin(1.1 * j + 0.9 * i), turn = 4.7 * t + 0.8;
    const d = [r * cos(turn) - 9, r * sin(turn), z - 5], square = d[0] ** 2 + d[1] ** 2 + d[2] ** 2;
    return [9 + 60 * d[0] / square, 60 * d[1] / square, 5 + 60 * d[2] / square];
});

/* Arches of a hall that branches in two, as a cage of 24 quads (Figures 2 and 11). */
function cage() {
    const points = [
        [-10, -4, 0], [-10.6, -3.6, 3.4], [-11.5, 0, 5.8], [-10.6, 3.6, 3.4], [-10, 4, 0], [-5, -4, 0], [-5, -3.3, 3],
        [-5, 0, 4.4], [-5, 3.3, 3], [-5, 4, 0], [0, -5, 0], [0, -4, 3.2], [1, 0, 4.6], [0, 4, 3.2], [0, 5, 0],
        [4, 0, 0], [3.2, 0, 2.8], [4, -8, 0], [4.4, -7, 2.9], [5.3, -5, 4], [6.2, -3, 2.9], [6.6, -2, 0], [7, -11, 0],
        [7.8, -10.2, 3.2], [9.4, -8, 5], [10.4, -5.8, 3.2], [10, -4.6, 0], [6.6, 2, 0], [6.2, 3, 2.9], [5.3, 5, 4],
        [4.4, 7, 2.9], [4, 8, 0], [10, 4.6, 0], [10.4, 5.8, 3.2], [9.4, 8, 5], [7.8, 10.2, 3.2], [7, 11, 0]
    ];
    const arch = first => [0, 1, 2, 3, 4].map(k => first + k), near = [10, 11, 12, 16, 15], far = [15, 16, 12, 13, 14];
    const spans = [
        [arch(0), arch(5)], [arch(5), arch(10)], [near, arch(17)], [arch(17), arch(22)], [far, arch(27)],
        [arch(27), arch(32)]
    ];
    return textOf(points, spans.flatMap(([a, b]) => [0, 1, 2, 3].map(k => [a[k], b[k], b[k + 1], a[k + 1]])));
}

const gallery = [
    {
        name: 'Roof', group: 'Begin', rules: {planar: 1, gliding: 1, fairness: 0.1},
        hint: 'Orange panels are warped. Solve makes all of them flat; then pull a vertex: they stay flat.',
        make: () => grid(20, 20, (s, t) => {
            const x = s - 0.5, y = t - 0.5;
            return [20 * x, 20 * y, 2.2 * cos(6.5 * x) + 1.6 * cos(4.5 * y + 1.5 * x * x) + 1.5 * x * y];
        }),
    },
    {
        name: 'Flat sheet', group: 'Begin', rules: {planar: 1, fixedCorners: 1},
        hint: 'Already flat. Pull the middle up: the panels stay flat while the sheet bends.',
        make: () => grid(12, 16, (s, t) => [8 * t - 4, 6 * s - 3, 0]),
    },
    {
        name: 'Tower', group: 'Begin', rules: {planar: 1, fixedBoundary: 1, fairness: 0.2},
        hint: 'A twisted tower whose panels are far from flat. Solve, then pull its waist.',
        make: () => grid(16, 24, (s, t) => {
            const turn = 2 * PI * (t + 0.12 * s), r = 1 + 0.45 * (2 * s - 1) ** 2 + 0.12 * cos(4 * PI * t);
            return [r * cos(turn), 0.8 * r * sin(turn), 3.2 * s];
        }, true),
    },
    {
        name: 'Shell', group: 'Begin', rules: {equilibrium: 1, fixedBoundary: 1}, colour: 'forces',
        hint: 'Edges carry the weight of the panels. Solve: blue pushes, red pulls. Then ask for compression only.',
        make: () => grid(14, 20, (s, t) => {
            const x = 10 * t - 5, y = 7 * s - 3.5;
            return [x, y, 2.6 * (1 - (x / 5) ** 2) * (1 - (y / 3.5) ** 2) + 0.9 * cos(PI * x / 5) * (y / 3.5) ** 2];
        }),
    },
    {
        name: 'Hexagons', group: 'Begin', rules: {planar: 1, closeness: 0.05, fairness: 0.1},
        hint: 'Hexagons have more freedom to be flat. Solve, then pull with a long reach.',
        make: () => honeycomb(11, 12, (x, y) => {
            const u = 2 * x - 1, v = 2 * y - 1;
            return [5 * u, 5.4 * v, 2.4 * (1 - u * u) * (1 - 0.8 * v * v) + 0.25 * sin(5 * u) * cos(3 * v)];
        }),
    },
    {
        name: 'Cage', group: 'Begin', rules: {planar: 1, fairness: 0.1},
        hint: 'A cage of few panels. Pull at it, then Subdivide: each becomes four, and a smooth form appears. Solve.',
        make: () => grid(2, 4, (s, t) => {
            const high = t === 0.5 ? 1.6 : t % 0.5 ? 1.2 : 0;
            return [4 * t - 2, 3 * s - 1.5, high * (s === 0.5 ? 1 : 1.3)];
        }),
    },
    {
        name: 'Canopy', figure: '1', group: 'From the paper', colour: 'forces', example: 'self_supporting_roof.c',
        rules: {planar: 1, equilibrium: 1, compression: 1, gliding: 1, reference: 0.1, fairness: 0.1},
        hint: 'Flat panels that stand by compression alone, though the canopy overhangs its own foot.',
        make: () => grid(18, 50, (s, t) => {
            const turn = 2 * PI * t, r = 2.3 - 4.2 * s + 6.6 * s * s;
            return [1.15 * r * cos(turn), r * sin(turn), 4.2 * sin(2.2 * s) + 0.4 * s ** 3 * cos(5 * turn)];
        }, true),
    },
    {
        name: 'Branching hall', figure: '2', group: 'From the paper', levels: 2, example: 'subdivision_design.c',
        rules: {planar: 1, gliding: 1, reference: 0.1, fairness: 0.02, tangential: 0.05},
        hint: 'A cage of 24 quads, subdivided twice. Solve makes its 384 panels flat.',
        make: cage,
    },
    {
        name: 'Carpet', figure: '3', group: 'From the paper', colour: 'bends', example: 'hybrid_fairing.c',
        rules: {planar: 1, gliding: 1, reference: 0.1, tangential: 0.1, gauss: 0.3},
        hint: 'Normals jump from panel to panel. Solve: the Gauss image becomes calm while all panels are flat.',
        make: () => carpet(24, 14),
    },
    {
        name: 'Filled curve', figure: '4', group: 'From the paper', corners: 5, lift: 5, example: 'boundary_fill.c',
        rules: {planar: 1, gliding: 1, fairness: 0.3, closeness: 0.05},
        hint: 'A curve on the ground, filled with quads from five corners and lifted. Solve makes the panels flat.',
        make: () => curve(60, a => {
            const r = 10 + 1.5 * cos(3 * a) + 1.2 * sin(a);
            return [r * cos(a), r * sin(a), 0];
        }),
    },
    {
        name: 'House', figure: '5', group: 'From the paper', fix: (v, p) => p[2] < 1e-9, example: 'volume.c',
        rules: {planar: 1, volume: 1.3, fairness: 0.12, closeness: 0.1},
        hint: 'A house of blocks on its floor. Solve: it grows by the volume that you ask for, and panels stay flat.',
        make: blocks,
    },
    {
        name: 'Equal areas', figure: '6', group: 'From the paper', example: 'equal_areas.c',
        rules: {planar: 1, gliding: 1, reference: 0.1, tangential: 0.05, equalAreas: 0.2},
        hint: 'An oval dome of hexagons. Solve makes them flat and wishes that all have one area.',
        make: () => dome(88, 11),
    },
    {
        name: 'Courtyard', figure: '7', group: 'From the paper', colour: 'forces', example: 'courtyard.c',
        rules: {planar: 1, equilibrium: 1, compression: 1, gliding: 1, fairness: 0.02, closeness: 0.02},
        hint: 'Flat diamonds over four walls, by compression alone. Then ask for more volume, or for even forces.',
        make: () => diamonds(20, (x, y) => [14 * x, 10 * y, 6 * cos(PI * x / 2) * cos(PI * y / 2)]),
    },
    {
        name: 'Ribs', figure: '8', group: 'From the paper', example: 'parallelograms.c',
        fix: (v, p) => hypot(p[0], p[1]) > 13.9,
        rules: {planar: 1, closeness: 0.02, fairness: 0.05, parallelograms: 2},
        hint: 'A canopy on five feet. Nobody asks for ribs: panels that like to be parallelograms make them.',
        make: () => sectors(5, 12),
    },
    {
        name: 'Horn', figure: '12', group: 'From the paper', colour: 'forces', example: 'thrust_network.c',
        rules: {equilibrium: 1, compression: 1, fixedBoundary: 1, fairness: 0.05, tangential: 0.05},
        hint: 'Compression alone in a net that is no height field: its underside overhangs.',
        make: () => horn(36, 16),
    },
    {
        name: 'Greenhouse', figure: '13', group: 'From the paper', colour: 'forces', example: 'greenhouse.c',
        corners: 4,
        rules: {equilibrium: 1, compression: 1, gliding: 1, lifting: 1},
        hint: 'A flat net. Solve lifts it until it stands. Then free the heights, ask for right angles and fair lines.',
        make: () => curve(44, a => {
            const turn = a + 0.12 * sin(2 * a);
            return [14 * cos(turn), 8 * sin(turn) - 1.5 * cos(2 * turn), 0];
        }),
    },
    {
        name: 'Circular', figure: '3.5', group: 'From the paper', example: 'circular_mesh.c',
        rules: {planar: 1, circular: 1, fairness: 0.02, closeness: 0.03},
        hint: 'Every panel gets a circumcircle: such meshes have a second layer whose nodes are all equally far.',
        make: funnel,
    },
    {
        name: 'Conical', figure: '3.5', group: 'From the paper', example: 'conical_mesh.c',
        rules: {planar: 1, conical: 1, fairness: 0.01, closeness: 0.03},
        hint: 'Panels around a node touch a cone: such meshes have a second layer whose panels are all equally far.',
        make: () => hall(28, 10),
    },
    {
        name: 'Impossible', group: 'Limits', rules: {planar: 1, fixedBoundary: 1},
        hint: 'The fixed boundary is twisted: no middle makes four flat panels. The verdict names what contradicts.',
        make: () => grid(2, 2, (s, t) => [2 * t - 1, 2 * s - 1, 0.5 * (2 * s - 1) * (2 * t - 1)]),
    },
    {
        name: 'Large roof', group: 'Limits', rules: {planar: 1, fixedCorners: 1},
        hint: 'Ten thousand vertices: solve, stop, pull.',
        make: () => grid(84, 118, (s, t) => {
            const x = 12 * t - 6, y = 9 * s - 4.5;
            return [x, y, 2 * cos(0.28 * x) * cos(0.33 * y) + 0.25 * sin(1.1 * x + 0.4 * y)];
        }),
    },
];
