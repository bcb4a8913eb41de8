#!/bin/sh
# noh build TAKE.trc|TAKE.c3d: markers become joints of their names, where and when they were.
. "$(dirname "$0")/lib.sh"

warns() { # TEXT
    check "it warns: $1" grep -qF -- "$1" "$work/out"
}
refuses() { # FILE TEXT
    noh build "$work/$1" -o "$work/refused.noh"
    expect 1 "$1 is refused"
    says "$2"
}
if ! command -v python3 >/dev/null 2>&1; then
    skip 'markers' 'no python3 here'
    finish
fi

# Three frames of two markers: A at (1,2,3), (2,2,3), (3,2,3) m; B at (0,1,0) in the first and (0,1,2) in the last, y up.
cat >"$work/make.py" <<'PY'
import struct, sys
work = sys.argv[1]
A = [(1, 2, 3), (2, 2, 3), (3, 2, 3)]
B = [(0, 1, 0), None, (0, 1, 2)]

def trc(name, unit, scale, rows):
    with open(work + '/' + name, 'w') as f:
        f.write('PathFileType\t4\t(X/Y/Z)\t%s\r\n' % name)
        f.write('DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\r\n')
        f.write('50.00\t50.00\t%d\t3\t%s\t50.00\t1\t%d\r\n' % (len(rows), unit, len(rows)))
        f.write('Frame#\tTime\tL.Knee\t\t\tR Ankle\t\t\tlost\t\t\t\r\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\r\n\r\n')
        for i, row in enumerate(rows):
            f.write('%d\t%.3f' % (i + 1, i / 50))
            for p in row + [None]:
                f.write(''.join('\t' + ('%.4f' % (c * scale) if p else '') for c in p or (0, 0, 0)))
            f.write('\r\n')
rows = [[A[i], B[i]] for i in range(3)]
trc('metres.trc', 'm', 1, rows)
trc('millimetres.trc', 'mm', 1000, rows)
trc('leagues.trc', 'league', 1, rows)

def c3d(name, processor, as_floats, up='+Z'):
    e = '>' if processor == 86 else '<'
    def f32(x):
        b = struct.pack(e + 'f', x * 4 if processor == 85 else x)
        return b[2:] + b[:2] if processor == 85 else b
    i16 = lambda x: struct.pack(e + 'h', x)
    def parameter(name, kind, dims, data):
        body = struct.pack('bB', kind, len(dims)) + bytes(dims) + data + b'\0'
        return struct.pack('bb', len(name), 1) + name + i16(len(body) + 2) + body
    scale = -0.1 if as_floats else 0.1
    p = bytes([0, 0, 2, processor])
    p += parameter(b'UNITS', -1, [4], b'mm  ') + parameter(b'LABELS', -1, [8, 3], b'L.Knee  R Ankle         ')
    p += parameter(b'SCALE', 4, [], f32(scale)) + parameter(b'RATE', 4, [], f32(50.0)) + parameter(b'DATA_START', 2, [], i16(4))
    if up:
        p += parameter(b'Y_SCREEN', -1, [2], up.encode())
    p += struct.pack('bb', 5, -1) + b'POINT' + i16(3) + b'\0' + b'\0\0'
    h = bytes([2, 0x50]) + i16(3) + i16(2) + i16(7) + i16(9) + i16(0) + f32(scale) + i16(4) + i16(1) + f32(50.0)
    out = h + bytes(512 - len(h)) + p + bytes(1024 - len(p))
    for i in range(3):
        for m in (A[i], B[i], None):
            x, y, z = m or (0, 0, 0)
            x, y, z = {'+Y': (x, y, z), '-Z': (x, z, -y), '+X': (y, -x, z)}.get(up, (x, -z, y))
            values = [1000 * v for v in (x, y, z)]
            if as_floats:
                out += b''.join(f32(v) for v in values) + f32(0.0 if m else -1.0)
            else:
                out += b''.join(i16(round(v / 0.1)) for v in values) + i16(0 if m else -1)
        out += (f32 if as_floats else lambda v: i16(int(v)))(7.0) * 2
    open(work + '/' + name, 'wb').write(out)
for processor in (84, 85, 86):
    for floats in (0, 1):
        c3d('c%d%d.c3d' % (processor, floats), processor, floats)
c3d('up_y.c3d', 84, 1, '+Y')
c3d('up_x.c3d', 84, 1, '+X')
c3d('down.c3d', 84, 1, '-Z')
c3d('unnamed.c3d', 84, 1, None)
data = open(work + '/c841.c3d', 'rb').read()
open(work + '/cut.c3d', 'wb').write(data[:-40])
open(work + '/not.c3d', 'wb').write(b'not' * 400)
open(work + '/vax.c3d', 'wb').write(data[:515] + b'\x01' + data[516:])
open(work + '/not.trc', 'w').write('Frame#\t1\n')
PY
check 'the recordings are made' python3 "$work/make.py" "$work"

# Frames of every joint by name, from what noh clip --dump writes: centimetres.
cat >"$work/places.py" <<'PY'
import struct, sys
b = open(sys.argv[1], 'rb').read()
joints, frames, rate, n = struct.unpack_from('<IIfI', b, 4)
at, rows = 20 + n, []
for j in range(joints):
    parent, flags, n = struct.unpack_from('<iII', b, at)
    name = b[at + 12:at + 12 + n].decode()
    first = struct.unpack_from('<10f', b, at + 12 + n + 40)
    rows.append([name, flags, first, []])
    at += 12 + n + 80
for f in range(frames):
    for r in rows:
        t = r[2][4:7]
        if r[1] & 1: at += 16
        if r[1] & 2: t = struct.unpack_from('<3f', b, at); at += 12
        if r[1] & 4: at += 12
        r[3].append(t)
print('%g Hz' % rate, '; '.join('%s %s' % (r[0], ' '.join(','.join('%.0f' % (c + 0.0) for c in t) for t in r[3])) for r in sorted(rows)))
PY
wanted='50 Hz; L.Knee 100,200,300 200,200,300 300,200,300; R Ankle 0,100,0 0,100,100 0,100,200; markers 0,0,0 0,0,0 0,0,0'
shows() { # FILE
    noh build "$work/$1" -o "$work/take.noh"
    expect 0 "build $1"
    cp "$work/out" "$work/said"
    noh clip "$work/take.noh" --clip "${1%.*}" --dump "$work/take.rcl"
    is=$(python3 "$work/places.py" "$work/take.rcl" | sed 's/-0\([,; ]\)/0\1/g; s/Hz /Hz; /')
    check "$1 has its markers: $is" test "$is" = "$wanted"
    cp "$work/said" "$work/out"
}
for file in metres.trc millimetres.trc c840.c3d c841.c3d c850.c3d c851.c3d c860.c3d c861.c3d up_y.c3d up_x.c3d down.c3d; do
    shows $file
done
warns 'in no frame: left out'
warns 'places of markers were interpolated where no camera saw them'
shows unnamed.c3d
warns 'POINT:Y_SCREEN is missing: z was taken as up'
noh build "$work/cut.c3d" -o "$work/cut.noh"
expect 0 'a recording that is cut off'
warns 'the file ends before its last frame'
refuses leagues.trc 'Units is none of mm, cm, m and in'
noh build "$work/leagues.trc" -o "$work/leagues.noh" --unit-cm 100
expect 0 'the unit may be given'
refuses not.trc 'it does not start with PathFileType'
refuses not.c3d 'this is not a .c3d file'
refuses vax.c3d 'the processor is none of Intel, DEC and MIPS'

finish
