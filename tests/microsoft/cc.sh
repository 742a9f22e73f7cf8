#!/bin/bash
# cc.sh OPTIONS... FILE [OBJECT...] [-o OUT] - compiles as Microsoft's compiler does, as far as that can be had here: clang
# takes its dialect and its ABI, and is called neither clang nor gcc, with headers of our own that declare what its
# headers do. Without -c and -fsyntax-only mingw links the result with its C library.
objects=() options=() link=1 out=
while [ $# -gt 0 ]; do
    case $1 in
    -o) out=$2 && shift ;;
    *.o) objects+=("$1") ;;
    -l* | -pthread) ;;
    *) options+=("$1") ;;
    esac
    case $1 in -c | -fsyntax-only) link= ;; esac
    shift
done
compile() {
    clang --target=x86_64-pc-windows-msvc -U__clang__ -U__GNUC__ -D_MSC_VER=1929 -fms-extensions -fms-compatibility \
        -fms-compatibility-version=19.29 -nostdlibinc -ffreestanding -mno-stack-arg-probe \
        -I"$(dirname "$0")" "${options[@]}" "$@"
}
if [ -n "$link" ]; then
    compile -c -o "$out.obj" && x86_64-w64-mingw32-gcc "$out.obj" "${objects[@]}" -static -lpthread -o "$out"
else
    compile ${out:+-o "$out"}
fi
