#!/bin/sh
# frame_table.sh MESH... - solves each mesh by guidedproj for planar faces, then for equilibrium by compression, too, with
# a fixed boundary; analyses both by frame under own weight: square steel tubes of 100 x 100 x 5 mm, edges of 1 m on
# average, clamped along the boundary. Prints a table in Markdown.
tools=$(dirname "$0")
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

value() { sed -n "s/.*\"$1\": \([-+.0-9e]*\).*/\1/p" "$work/frame.json" | head -n 1; }

row() { # row LABEL OPTIONS...: of what has been solved
    label=$1
    shift
    "$tools/frame" "$work/form.obj" --mean-edge 1 --fixed boundary --report "$work/frame.json" --quiet "$@" || exit 1
    LC_ALL=C awk -v label="$label" -v pulled="$(value edges_in_tension)" -v t="$(value max_tension)" \
        -v c="$(value max_compression)" -v form="$(value max_force)" -v r="$(value correlation)" -v a="$(value area)" \
        -v m="$(value max_bending)" -v w="$(value wy)" -v used="$(value max_utilisation)" -v u="$(value max_displacement)" \
        -v factor="$(value factor)" 'BEGIN {
            printf "| %s | %d, %.2f kN | %.2f kN | %s | %.2f, %.2f MPa | %.1f %% | %.2f mm | %.3g |\n", label, pulled,
                (t > 0 ? t : 0) / 1e3, c / 1e3, form == "" ? "" : sprintf("%.2f kN, %.2f", form / 1e3, r),
                c / a / 1e6, m / w / 1e6, 100 * used, 1e3 * u, factor }'
}

echo '| mesh | edges in tension, the most | compression | of the form, correlation | stress, axial and bending | of the yield stress | displacement | load factor |'
echo '|---|---|---|---|---|---|---|---|'
for mesh; do
    name=$(basename "$mesh" .obj)
    "$tools/guidedproj" "$mesh" -o "$work/form.obj" --planar --fix boundary --quiet || echo "$name: planarity does not come out" >&2
    row "$name, planar"
    "$tools/guidedproj" "$mesh" -o "$work/form.obj" --planar --equilibrium --compressive --fix boundary \
        --forces "$work/forces.csv" --quiet || echo "$name: equilibrium does not come out" >&2
    row "$name, in equilibrium" --forces "$work/forces.csv"
done
