/* gallery.js - meshes to begin with, made by formulas, as OBJ texts. Each has rules that are set when it is opened, and a
   sentence that says what to try. */
'use strict';

/* Quads in rows and columns: place(s, t), s and t in 0..1; `ring`: the last column meets the first. */
function grid(rows, columns, place, ring = false) {
    const across = ring ? columns : columns + 1, lines = [];
    for (let i = 0; i <= rows; ++i)
        for (let j = 0; j < across; ++j) lines.push('v ' + place(i / rows, j / columns).join(' '));
    for (let i = 0; i < rows; ++i)
        for (let j = 0; j < columns; ++j) {
            const a = i * across + j + 1, b = i * across + (j + 1) % across + 1;
            lines.push(`f ${a} ${a + across} ${b + across} ${b}`);
        }
    return lines.join('\n') + '\n';
}

/* Hexagons in offset rows over the unit square: place(x, y) bends them. Half hexagons stay out. */
function honeycomb(rows, columns, place) {
    const lines = [], number = new Map(), faces = [];
    const height = Math.sqrt(3) / 2;
    const at = (x, y) => {
        const key = `${Math.round(6 * x)},${Math.round(6 * y)}`;
        if (!number.has(key)) {
            number.set(key, number.size + 1);
            lines.push('v ' + place(x / (1.5 * columns), y * height / (height * 2 * rows)).join(' '));
        }
        return number.get(key);
    };
    for (let j = 0; j < columns; ++j)
        for (let i = 0; i < rows; ++i) {
            const x = 1.5 * j + 1, y = 2 * i + 1 + j % 2;
            faces.push('f ' + [[1, 0], [0.5, 1], [-0.5, 1], [-1, 0], [-0.5, -1], [0.5, -1]]
                .map(([dx, dy]) => at(x + dx, y + dy)).join(' '));
        }
    return lines.concat(faces).join('\n') + '\n';
}

const {sin, cos, PI} = Math;

const gallery = [
    {
        name: 'Roof', rules: {planar: 1, gliding: 1, fairness: 0.1},
        hint: 'Orange panels are warped. Solve makes all of them flat; then pull a vertex: they stay flat.',
        make: () => roofText,
    },
    {
        name: 'Tower', rules: {planar: 1, fixedBoundary: 1, fairness: 0.2},
        hint: 'A twisted tower whose panels are far from flat. Solve, then pull its waist.',
        make: () => grid(16, 24, (s, t) => {
            const turn = 2 * PI * (t + 0.12 * s), r = 1 + 0.45 * (2 * s - 1) ** 2 + 0.12 * cos(4 * PI * t);
            return [r * cos(turn), 0.8 * r * sin(turn), 3.2 * s];
        }, true),
    },
    {
        name: 'Shell', rules: {equilibrium: 1, fixedBoundary: 1}, colour: 'forces',
        hint: 'Edges carry the weight of the panels. Solve: blue is compression, red is tension. Then ask for compression only.',
        make: () => grid(14, 20, (s, t) => {
            const x = 10 * t - 5, y = 7 * s - 3.5;
            return [x, y, 2.6 * (1 - (x / 5) ** 2) * (1 - (y / 3.5) ** 2) + 0.9 * cos(PI * x / 5) * (y / 3.5) ** 2];
        }),
    },
    {
        name: 'Hexagons', rules: {planar: 1, closeness: 0.05, fairness: 0.1},
        hint: 'Hexagons have more freedom to be flat. Solve, then pull with a long reach.',
        make: () => honeycomb(11, 12, (x, y) => {
            const u = 2 * x - 1, v = 2 * y - 1;
            return [5 * u, 5.4 * v, 2.4 * (1 - u * u) * (1 - 0.8 * v * v) + 0.25 * sin(5 * u) * cos(3 * v)];
        }),
    },
    {
        name: 'Round panels', rules: {planar: 1, circular: 1, fairness: 0.2},
        hint: 'Every panel gets a circumcircle: such meshes have an offset at constant distance.',
        make: () => grid(14, 20, (s, t) => {
            const x = 6 * t - 3, y = 4.4 * s - 2.2;
            return [x + 0.12 * y * y, y, 0.16 * x * x - 0.2 * y * y + 0.1 * sin(2 * x)];
        }),
    },
    {
        name: 'Flat sheet', rules: {planar: 1, fixedCorners: 1},
        hint: 'Already flat. Pull the middle up: the panels stay flat while the sheet bends.',
        make: () => grid(12, 16, (s, t) => [8 * t - 4, 6 * s - 3, 0]),
    },
    {
        name: 'Impossible', rules: {planar: 1, fixedBoundary: 1},
        hint: 'The fixed boundary is twisted: no middle makes four flat panels. The verdict names what contradicts.',
        make: () => grid(2, 2, (s, t) => [2 * t - 1, 2 * s - 1, 0.5 * (2 * s - 1) * (2 * t - 1)]),
    },
    {
        name: 'Large roof', rules: {planar: 1, fixedCorners: 1},
        hint: 'Ten thousand vertices: solve, stop, pull.',
        make: () => grid(84, 118, (s, t) => {
            const x = 12 * t - 6, y = 9 * s - 4.5;
            return [x, y, 2 * cos(0.28 * x) * cos(0.33 * y) + 0.25 * sin(1.1 * x + 0.4 * y)];
        }),
    },
];
