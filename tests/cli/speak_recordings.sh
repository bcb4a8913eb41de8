#!/bin/sh
# noh speak on recordings: words found by time warping, compared with known phones; sound files of every kind.
. "$(dirname "$0")/lib.sh"

if [ -n "${NOH_SAN:-}" ]; then
    skip 'noh speak on recordings' 'it takes minutes under a sanitizer; test_ear hears recordings there'
    finish
fi
if ! command -v python3 >/dev/null 2>&1; then
    skip 'noh speak on recordings' 'there is no python3 to make sound files with'
    finish
fi
noh speak 'Papa bought me five boats.' --wav "$work/said.wav"
if grep -q 'eSpeak NG is not installed' "$work/err"; then
    skip 'noh speak on recordings' 'eSpeak NG is not installed'
    finish
fi
noh speak "$work/said.wav" --text 'Papa bought me five boats.'
if grep -q 'libsndfile, which is not installed' "$work/err"; then
    expect 1 'without libsndfile it is an error that says what to install'
    says 'libsndfile1'
    skip 'noh speak on recordings' 'libsndfile is not installed'
    finish
fi
expect 0 'its own voice'
noh speak "$work/said.wav" --live --text 'Papa bought me five boats.'
expect 2 'words, or an ear'
noh speak 'Hello' --live
expect 2 'a text is not heard'
says 'recording without words'

# ---- sound files of every kind: the phones of one text stay where they are ----
cat >"$work/kinds.py" <<'PY'
import random, struct, sys, wave
work = sys.argv[1]
w = wave.open(work + '/said.wav')
rate = w.getframerate()
x = struct.unpack('<%dh' % w.getnframes(), w.readframes(w.getnframes()))
def riff(name, tag, bits, channels, at, data, extra=b''):
    f = struct.pack('<HHIIHH', tag, channels, at, at * channels * bits // 8, channels * bits // 8, bits)
    body = b'WAVE' + b'LIST' + struct.pack('<I', 5) + b'noise\0' + b'fmt ' + struct.pack('<I', len(f)) + f + extra
    body += b'data' + struct.pack('<I', len(data)) + data
    open(work + '/' + name, 'wb').write(b'RIFF' + struct.pack('<I', len(body)) + body)
def at_rate(r):
    n = int(len(x) * r / rate)
    step = rate / r
    if step <= 1:
        return [x[min(int(i * step), len(x) - 1)] for i in range(n)]
    parts = [x[int(i * step):int((i + 1) * step)] for i in range(n)]
    return [sum(p) // len(p) for p in parts]
riff('u8.wav', 1, 8, 1, rate, bytes(128 + v // 256 for v in x))
riff('s24.wav', 1, 24, 1, rate, b''.join(struct.pack('<i', v * 256)[:3] for v in x))
riff('s32.wav', 1, 32, 1, rate, struct.pack('<%di' % len(x), *[v * 65536 for v in x]))
riff('f32.wav', 3, 32, 1, rate, struct.pack('<%df' % len(x), *[v / 32768 for v in x]))
riff('stereo.wav', 1, 16, 2, rate, struct.pack('<%dh' % (2 * len(x)), *[v for s in x for v in (s, s)]))
riff('opposite.wav', 1, 16, 2, rate, struct.pack('<%dh' % (2 * len(x)), *[v for s in x for v in (s // 2, -(s // 2))]))
riff('three.wav', 1, 16, 3, rate, struct.pack('<%dh' % (3 * len(x)), *[v for s in x for v in (s // 4, -s // 2, s // 4)]))
riff('one_side.wav', 1, 16, 2, rate, struct.pack('<%dh' % (2 * len(x)), *[v for s in x for v in (s, 0)]))
for r in (8000, 11025, 16000, 44100, 48000):
    y = at_rate(r)
    riff('r%d.wav' % r, 1, 16, 1, r, struct.pack('<%dh' % len(y), *y))
random.seed(1)
noisy = [max(-32768, min(32767, v + int(random.gauss(0, 200)))) for v in x]
riff('noise.wav', 1, 16, 1, rate, struct.pack('<%dh' % len(x), *noisy))
riff('silent.wav', 1, 16, 1, rate, bytes(2 * len(x)))
riff('loud.wav', 1, 16, 1, rate, struct.pack('<%dh' % len(x), *[max(-32768, min(32767, 20 * v)) for v in x]))
riff('short.wav', 1, 16, 1, rate, struct.pack('<400h', *x[2000:2400]))
riff('none.wav', 1, 16, 1, rate, b'')
riff('slow.wav', 1, 16, 1, 100, bytes(400))
whole = open(work + '/said.wav', 'rb').read()
open(work + '/cut.wav', 'wb').write(whole[:30])
open(work + '/half.wav', 'wb').write(whole[:len(whole) // 2])
nan = b'\0\0\xc0\x7f'
riff('nan.wav', 3, 32, 1, rate, nan * len(x))
open(work + '/empty.wav', 'wb').close()
open(work + '/empty.txt', 'wb').close()
PY
check 'sound files of every kind' python3 "$work/kinds.py" "$work"
cat >"$work/near.py" <<'PY'
import json, sys
a, b, most = json.load(open(sys.argv[1])), json.load(open(sys.argv[2])), float(sys.argv[3])
p, q = ([x for x in j['phones'] if x['phone']] for j in (a, b))
assert [x['phone'] for x in p] == [x['phone'] for x in q]
off = sorted(abs(x['start_s'] - y['start_s']) for x, y in zip(p, q))
assert off[len(off) // 2] <= most, off
assert set(b) >= {'seconds', 'source', 'latency_ms', 'phones', 'frames', 'score', 'words_match'}
assert b['words_match'] and b['source'] == 'recording and text', b['score']
f = b['frames']
assert f['rate_hz'] == 100 and len(f['viseme']) == len(f['open']) == len(f['round']) >= 100 * b['seconds'] - 1
assert set(f['viseme']) <= set('sil PP FF TH DD kk CH SS nn RR aa E ih oh ou'.split())
assert all(0 <= v <= 1 for v in f['open'] + f['round'])
ends = [x['end_s'] for x in b['phones']]
assert ends[-1] <= b['seconds'] + 1e-6 and [x['start_s'] for x in b['phones']][1:] == ends[:-1]
PY
noh speak 'Papa bought me five boats.' --json
cp "$work/out" "$work/text.json"
for kind in said u8 s24 s32 f32 stereo r8000 r11025 r16000 r44100 r48000 noise; do
    noh speak "$work/$kind.wav" --text 'Papa bought me five boats.' --json
    expect 0 "$kind.wav is read"
    cp "$work/out" "$work/$kind.json"
    check 'its phones begin where they do, 20 ms' python3 "$work/near.py" "$work/text.json" "$work/$kind.json" 0.02
done
# Channels that take each other away: the loudest is taken, and not where one is silent.
for kind in opposite:1 three:2; do
    noh speak "$work/${kind%:*}.wav" --text 'Papa bought me five boats.' --json
    expect 0 "${kind%:*}.wav is read"
    says "only channel ${kind#*:} is used"
    cp "$work/out" "$work/phase.json"
    check 'its phones begin where they do, 20 ms' python3 "$work/near.py" "$work/text.json" "$work/phase.json" 0.02
done
noh speak "$work/opposite.wav" --json
says 'only channel 1 is used'
for kind in stereo one_side; do
    noh speak "$work/$kind.wav" --text 'Papa bought me five boats.' --json
    check "$kind.wav: no warning" sh -c '! grep -q "only channel" "$1"' - "$work/err"
done
for broken in 'empty.wav:cannot be read as sound' 'none.wav:contains no samples' 'cut.wav:' \
    'kinds.py:cannot be read as sound' \
    'silent.wav:silent' 'nan.wav:silent' 'slow.wav:samples a second' 'short.wav:too short' 'missing.wav:'; do
    noh speak "$work/${broken%%:*}" --text 'Papa bought me five boats.' --face "$build/mask.noh" -o "$work/other.noh"
    expect 1 "${broken%%:*} is refused"
    says "${broken#*:}"
done
check 'and nothing is left behind' sh -c '! test -e "$1"' - "$work/other.noh"

noh speak "$work/said.wav" --text "$(yes 'Papa bought me five boats.' | head -n 1000 | tr '\n' ' ')"
expect 1 'more words than anyone could say in it'
says 'bytes of text are too many for'

# ---- German: another throat than the warp's, made by other means (Klatt) ----
german='Am Montag brachte Peter seiner Mutter bunte Blumen und ein Buch.'
noh speak "$german" --lang de+klatt4 --wav "$work/german.wav" --json
expect 0 'a sentence in German'
cp "$work/out" "$work/text.json"
noh speak "$work/german.wav" --text "$german" --lang de --json
expect 0 'is found in its recording'
cp "$work/out" "$work/german.json"
check 'its phones begin where they do, 15 ms' python3 "$work/near.py" "$work/text.json" "$work/german.json" 0.015

# ---- without words: heard ----
cat >"$work/heard.py" <<'PY'
import json, sys
j, method, latency = json.load(open(sys.argv[1])), sys.argv[2], float(sys.argv[3])
assert j['source'] == 'recording' and j['method'] == method and j['latency_ms'] == latency, j['latency_ms']
assert set(j) >= {'seconds', 'source', 'latency_ms', 'phones', 'frames'}
f, p = j['frames'], j['phones']
assert f['rate_hz'] == 100 and len(f['viseme']) == len(f['open']) == len(f['round']) >= 100 * j['seconds'] - 1
assert all(0 <= v <= 1 for v in f['open'] + f['round'])
assert p[0]['start_s'] == 0 and abs(p[-1]['end_s'] - j['seconds']) < 1e-6
assert [x['start_s'] for x in p][1:] == [x['end_s'] for x in p][:-1]
assert all(x['viseme'] != y['viseme'] for x, y in zip(p, p[1:]))
spoken = len(sys.argv) > 4
assert not spoken or (max(f['open']) > 0.4 and len(p) > 8), (max(f['open']), len(p))
assert spoken or max(f['open']) < 0.1, max(f['open'])
PY
for kind in said u8 s24 f32 stereo r8000 r48000 noise loud half; do
    noh speak "$work/$kind.wav" --json
    expect 0 "$kind.wav is heard"
    cp "$work/out" "$work/heard.json"
    check 'shapes of speech' python3 "$work/heard.py" "$work/heard.json" ear 0 spoken
done
noh speak "$work/said.wav" --live --json
cp "$work/out" "$work/heard.json"
check 'live: 40 ms late, and it says so' python3 "$work/heard.py" "$work/heard.json" ear 40 spoken
noh speak "$work/said.wav" --live --latency 80 --json
cp "$work/out" "$work/heard.json"
check 'or 80 ms' python3 "$work/heard.py" "$work/heard.json" ear 80 spoken
for late in 39 81; do
    noh speak "$work/said.wav" --live --latency $late
    expect 2 "$late ms is refused"
    says 'must be 40 to 80 ms'
done
noh speak "$work/said.wav" --latency 80
expect 2 'a latency is of live sound'
says '--live'
noh speak "$work/said.wav" --amplitude --json
cp "$work/out" "$work/heard.json"
check 'by loudness alone' python3 "$work/heard.py" "$work/heard.json" amplitude 0 spoken
noh speak "$work/said.wav" --amplitude --live --json
cp "$work/out" "$work/heard.json"
check 'which is later' python3 "$work/heard.py" "$work/heard.json" amplitude 100 spoken
for kind in silent short nan; do
    for how in --live --amplitude; do
        noh speak "$work/$kind.wav" $how --json
        expect 0 "$kind.wav, $how"
        cp "$work/out" "$work/heard.json"
        case $how in --live) method='ear 40' ;; *) method='amplitude 0' ;; esac
        # shellcheck disable=SC2086 # two words
        [ $kind = short ] || check 'and the mouth stays shut' python3 "$work/heard.py" "$work/heard.json" $method
    done
done
for broken in 'empty.wav:cannot be read as sound' 'none.wav:contains no samples' 'slow.wav:samples a second'; do
    noh speak "$work/${broken%%:*}" --face "$build/mask.noh" -o "$work/other.noh"
    expect 1 "${broken%%:*} is refused"
    says "${broken#*:}"
done
for how in '' --live --amplitude; do
    noh speak "$work/said.wav" $how --face "$build/mask.noh" -o "$work/heard.noh"
    expect 0 "a clip of what is heard $how"
    noh info "$work/heard.noh"
    check 'it has floats for the face' grep -q "clip 'speech': .* floats" "$work/out"
    noh render "$build/mask.noh" --size 64x64 -o "$work/rest.png"
    noh render "$build/mask.noh" --size 64x64 -o "$work/open.png" --anim "$work/heard.noh" --clip speech --time 0.3
    check 'and moves it' sh -c '! cmp -s "$1" "$2"' - "$work/rest.png" "$work/open.png"
done
noh speak "$work/half.wav" --text 'Papa bought'
expect 0 'a file cut short is read as far as it goes'
noh speak "$work/loud.wav" --text 'Papa bought me five boats.'
expect 0 'a clipped recording'
says 'clipped'
noh speak "$work/said.wav" --text-file "$work/empty.txt"
expect 1 'an empty text'
says 'write the words to speak'
noh speak "$work/said.wav" --text ' . '
expect 1 'a text without words'
noh speak "$work/said.wav" --text 'The sun rose over seven hills.'
expect 0 'other words than in the recording'
says 'do not seem to match the recording'

# ---- clips ----
noh speak "$work/said.wav" --text 'Papa bought me five boats.' --face "$build/mask.noh" -o "$work/line.noh"
expect 0 'a clip for the mask'
noh info "$work/line.noh"
check 'one clip, a key for each word' grep -q "clip 'speech': .* floats, .* 5 callback keys" "$work/out"
cp "$work/line.noh" "$work/first.noh"
noh speak "$work/said.wav" --text 'Papa bought me five boats.' --face "$build/mask.noh" -o "$work/line.noh"
check 'the same bytes every time' cmp "$work/line.noh" "$work/first.noh"

# ---- ten sentences: phones begin at the synthesiser's samples ----
cat >"$work/exact.py" <<'PY'
import json, sys
j = json.load(open(sys.argv[1]))
starts = [p['start_s'] * 22050 for p in j['phones']]
assert len(starts) > 5 and j['source'] == 'text' and j['latency_ms'] == 0
assert all(abs(s - round(s)) < 1e-3 for s in starts) and starts == sorted(starts)
assert [p['end_s'] for p in j['phones']][:-1] == [p['start_s'] for p in j['phones']][1:]
for p in j['phones']:
    k = int(50 * (p['start_s'] + p['end_s']))
    if p['viseme'] == 'PP' and p['end_s'] - p['start_s'] >= 0.02:
        assert j['frames']['viseme'][k] == 'PP' and j['frames']['open'][k] < 0.05, (p, k)
PY
while IFS=: read -r lang text; do
    noh speak "$text" --lang "$lang" --json
    expect 0 "$lang: $text"
    cp "$work/out" "$work/sentence.json"
    check 'phones begin at samples, lips meet' python3 "$work/exact.py" "$work/sentence.json"
done <<'END'
en-us:My mother bought a big blue umbrella.
en-us:Five of them have never seen the river.
en-us:Please stop before the bridge.
en-us:How much wood would you chop?
en-gb:The people in the boat were very happy.
de:Mein Bruder braucht ein paar Blumen.
de:Wir haben sieben Äpfel und fünf Birnen.
de:Am Abend bleiben wir zu Hause.
de:Warum fragst du mich immer so viel?
de:Das Pferd läuft über die Brücke.
END

# ---- real speech, with phones that are known ----
speech=$assets/speech
if [ ! -f "$speech/bobby.phones" ]; then
    skip 'real speech' 'the recordings are not here (NOH_ASSETS)'
    finish
fi
for wav in "$speech"/*.wav; do
    noh speak "$wav" --text-file "${wav%.wav}.txt" --labels "${wav%.wav}.phones" --json
    expect 0 "$(basename "$wav")"
    cp "$work/out" "$work/$(basename "$wav" .wav).labels.json"
done
check 'visemes, lips, closures, onsets' python3 -c '
import glob, json, sys
files = [json.load(open(f)) for f in glob.glob(sys.argv[1] + "/*.labels.json")]
l = [j["labels"] for j in files]
total = lambda key: sum(x[key] for x in l)
visemes, lips = total("visemes_right") / total("frames"), total("lips_right") / total("frames")
onset = sum(x["onset_median_s"] * x["onsets"] for x in l) / total("onsets")
print("visemes %.3f, lips %.3f of %d frames; p, b, m %d of %d; onsets %.1f ms" % (visemes, lips, total("frames"),
      total("closures_found"), total("closures"), 1000 * onset))
assert visemes >= 0.79 and lips >= 0.855 and total("closures_found") == total("closures") and onset <= 0.018
assert all(j["words_match"] for j in files)
' "$work"
cat "$work/check" | sed 's/^/# /'
noh speak "$speech/sense_0920.wav" --text-file "$speech/sense_0890.txt"
expect 0 'the words of another recording'
says 'do not seem to match the recording'
finish
