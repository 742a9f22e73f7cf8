#!/bin/sh
# frame_table.sh MESH... - each mesh by ./guidedproj with planar faces, and with equilibrium by compression as well, its
# boundary fixed, and both by ./frame under their own weight: steel tubes of 100 x 100 x 5 mm, edges of 1 m on average,
# clamped along the boundary. Prints a table in Markdown.
cd "$(dirname "$0")" || exit 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

value() { sed -n "s/.*\"$1\": \([-+.0-9e]*\).*/\1/p" "$work/frame.json" | head -n 1; }

row() { # row NAME OPTIONS...: of what has been solved
    name=$1
    shift
    ./frame "$work/form.obj" --mean-edge 1 --fixed boundary --report "$work/frame.json" --quiet "$@" || exit 1
    correlation=$(value correlation)
    LC_ALL=C awk -v name="$name" -v tension="$(value edges_in_tension)" -v t="$(value max_tension)" \
        -v c="$(value max_compression)" -v r="$correlation" -v u="$(value max_displacement)" \
        -v used="$(value max_utilisation)" -v factor="$(value factor)" 'BEGIN {
            printf "| %s | %d | %.2f | %.2f | %s | %.2f | %.1f %% | %.4g |\n", name, tension, (t > 0 ? t : 0) / 1000,
                c / 1000, r == "" ? "" : sprintf("%.2f", r), u * 1000, used * 100, factor }'
}

echo '| mesh | edges in tension | largest tension, kN | largest compression, kN | correlation with the form | displacement, mm | utilisation | load factor |'
echo '|---|---|---|---|---|---|---|---|'
for mesh; do
    name=$(basename "$mesh" .obj)
    ./guidedproj "$mesh" -o "$work/form.obj" --planar --fix boundary --quiet || echo "$name: planarity does not come out" >&2
    row "$name, planar"
    ./guidedproj "$mesh" -o "$work/form.obj" --planar --equilibrium --compressive --fix boundary \
        --forces "$work/forces.csv" --quiet || echo "$name: equilibrium does not come out" >&2
    row "$name, and in equilibrium" --forces "$work/forces.csv"
done
