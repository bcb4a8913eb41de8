#!/bin/sh
# noh speak: phones in order with exact times, closed lips, a clip that plays on a face together with others.
. "$(dirname "$0")/lib.sh"

noh speak
expect 2 'no text is a usage error'
noh speak 'Hello' -o "$work/line.noh"
expect 2 'a pack wants a face'
says '--face'
noh speak 'Hello' --wav
expect 2 'an option without its value'

# Phones as a person wrote them, without a voice.
printf '0.10 0.30 P\n0.30 0.50 AA1\n\n0.60 0.80 M\n0.80 0.90 QQ\n' >"$work/line.phones"
noh speak 'Palm' --labels "$work/line.phones" --json
expect 0 'phones are given'
says "line 5: the phone 'QQ' is neither of ARPABET nor of IPA"
if [ -n "$json" ]; then
    for expression in 'j.source === "labels" && Math.abs(j.seconds - 0.9) < 1e-9' \
        'j.phones.map(p => p.phone).join() === ",P,AA1,,M,QQ"' \
        'j.phones.map(p => p.start_s).join() === "0,0.1,0.3,0.5,0.6,0.8"' \
        'j.frames.viseme[20] === "PP" && j.frames.viseme[40] === "aa" && j.frames.viseme[70] === "PP"' \
        'j.frames.open[40] > 0.6 && j.frames.open[70] < 0.05'; do
        if $json "$expression" <"$work/out"; then ok "$expression"; else not_ok "$expression"; fi
    done
fi
# A face's recipe knows phones of its own.
printf 'phone QQ oh ou\nphone P FF # in place of PP\n' >"$work/own.recipe"
noh build "$build/mask.glb" -o "$work/own.noh" --recipe "$work/own.recipe" --quiet
noh speak 'Palm' --labels "$work/line.phones" --face "$work/own.noh" --json
expect 0 'a face has mouth shapes of phones'
check 'no phone is unknown' sh -c '! grep -q QQ "$1"' - "$work/err"
if [ -n "$json" ]; then
    for expression in 'j.phones.map(p => p.viseme).join() === "sil,FF,aa,sil,PP,oh"' \
        'j.frames.viseme[20] === "FF" && j.frames.viseme[82] === "oh" && j.frames.viseme[88] === "ou"'; do
        if $json "$expression" <"$work/out"; then ok "$expression"; else not_ok "$expression"; fi
    done
fi
for row in 'phone' 'phone QQ' 'phone QQ smile' 'phone QQ oh ou aa' 'phone QQ oh
phone QQ ou'; do
    echo "$row" >"$work/bad.recipe"
    noh build "$build/mask.glb" -o "$work/bad.noh" --recipe "$work/bad.recipe" --quiet
    expect 1 "a bad row: $row"
done
noh speak 'Palm' --labels "$work/line.phones" --face "$build/mask.noh" -o "$work/palm.noh"
expect 0 'they make a clip'
noh info "$work/palm.noh"
check 'of 63 floats' grep -q "clip 'speech': 1.200 s, 0 joints, 63 floats" "$work/out"
noh speak 'Palm' --labels "$work/line.phones" --wav "$work/palm.wav"
expect 2 'which have no sound'
printf '0.5 0.6 P\n0.1 0.2 P\n' >"$work/back.phones"
noh speak 'Palm' --labels "$work/back.phones"
expect 1 'phones that go back'
says 'line 2: it starts before the line above'
mkfifo "$work/pipe.phones"
noh speak 'Palm' --labels "$work/pipe.phones"
expect 1 'a pipe, which may never end'
says 'pipe.phones: the file cannot be read: not a regular file'
noh speak 'Palm' --labels "$work"
expect 1 'a folder'
says 'Is a directory'

noh speak 'Papa bought me five boats.' --json
if grep -q 'eSpeak NG is not installed' "$work/err"; then
    expect 1 'without eSpeak NG it is an error that says what to install'
    says 'espeak-ng'
    skip 'noh speak' 'eSpeak NG is not installed'
    finish
fi
expect 0 'a sentence is said'
cp "$work/out" "$work/speech.json"
if [ -n "$json" ]; then
    check 'the source and the phones' sh -c 'cat "$1"' - "$work/speech.json"
    for expression in 'j.source === "text" && j.latency_ms === 0 && j.seconds > 1' \
        'j.phones[0].viseme === "PP" && j.phones[2].viseme === "PP" && j.phones[1].viseme === "aa"' \
        'j.phones[0].end_s === j.phones[1].start_s && j.phones[1].start_s > j.phones[0].start_s' \
        'j.frames.rate_hz === 100 && j.frames.viseme[0] === "sil"'; do
        if $json "$expression" <"$work/speech.json"; then ok "$expression"; else not_ok "$expression"; fi
    done
fi
# p, b, p, b, b, m and so on: at the middle of each the strongest shape is shut lips, and the mouth is not open
if command -v python3 >/dev/null 2>&1; then
    check 'lips meet for every p, b and m' python3 -c '
import json, sys
j = json.load(open(sys.argv[1]))
shut = [p for p in j["phones"] if p["viseme"] == "PP"]
assert len(shut) >= 4, len(shut)
for p in shut:
    k = round(100 * (p["start_s"] + p["end_s"]) / 2)
    assert j["frames"]["viseme"][k] == "PP", p
    assert j["frames"]["open"][k] < 0.05, (p, j["frames"]["open"][k])
assert len(j["frames"]["viseme"]) == len(j["frames"]["open"]) == len(j["frames"]["round"])
# starts are samples of 22,050 Hz
for p in j["phones"]:
    assert abs(p["start_s"] * 22050 - round(p["start_s"] * 22050)) < 1e-3, p
' "$work/speech.json"
fi

# phones in eSpeak NG's spelling
noh speak "Say [[p'A:m]]." --json
expect 0 'phones in brackets'
if [ -n "$json" ]; then
    if $json 'j.phones.map(p => p.viseme).slice(2, 5).join() === "PP,aa,PP"' <"$work/out"; then
        ok 'are said, not spelled'
    else
        not_ok 'are said, not spelled'
    fi
fi
noh speak 'Papa bought me five boats.' --face "$build/mask.noh" -o "$work/line.noh" --wav "$work/line.wav"
expect 0 'a clip for the mask'
check 'the sound is a RIFF file' sh -c 'test "$(head -c 4 "$1")" = RIFF && test "$(wc -c <"$1")" -gt 40000' - "$work/line.wav"
{ # 44 bytes of its head, then half a second of nothing
    head -c 44 "$work/line.wav"
    head -c 44100 /dev/zero
} >"$work/silent.wav"
noh speak "$work/silent.wav" --face "$build/mask.noh" -o "$work/silent.noh"
expect 0 'a silent recording'
says 'bytes of sound, and 44100 are there: it was cut off'
check 'stresses nothing' grep -q '^face: 0 stresses' "$work/out"
{ # a length that was not known when the head was written
    printf 'RIFF\044\360\377\177'
    head -c 40 "$work/line.wav" | tail -c 32
    printf '\000\360\377\177'
    head -c 44100 /dev/zero
} >"$work/piped.wav"
noh speak "$work/piped.wav" --face "$build/mask.noh" -o "$work/piped.noh"
expect 0 'a recording from a pipe'
check 'is whole' sh -c '! grep -q "cut off" "$1"' - "$work/err"
noh info "$work/line.noh"
check 'one clip, a key for each word' grep -q "clip 'speech': .* 63 floats, .* 5 callback keys" "$work/out"

# a puppet that walks and speaks: two packs of clips, and a face that lives
noh speak 'Papa bought me five boats.' --face "$build/demo/puppet_levels.noh" -o "$work/says.noh"
expect 0 'a clip for the puppet'
noh render "$build/demo/puppet_levels.noh" -o "$work/both.png" --anim "$build/demo/puppet_levels.noh" \
    --anim "$work/says.noh" --clip walk --clip speech --time 0.5 --size 64x64
expect 0 'two packs of clips'
noh render "$build/demo/puppet_levels.noh" -o "$work/walk.png" --clip walk --time 0.5 --size 64x64
check 'a walking figure speaks, too' sh -c '! cmp -s "$1" "$2"' - "$work/both.png" "$work/walk.png"
noh render "$build/mask.noh" -o "$work/still.png" --anim "$work/line.noh" --clip speech --time 0.5 --size 64x64
noh render "$build/mask.noh" -o "$work/joy.png" --anim "$work/line.noh" --clip speech --time 0.5 --size 64x64 \
    --face on --feel joy=1
expect 0 'a face that lives'
check 'and feels' sh -c '! cmp -s "$1" "$2"' - "$work/still.png" "$work/joy.png"
noh speak 'I really love to dance, but today, I am tired.' --json
expect 0 'speech for the whole face'
check 'stress raises brows and nods; a pause blinks' awk '/"(brows|nod|blink)": \[/ { key = $1 } /\]/ { key = "" }
    key != "" { sub(",", "", $1); if ($1 + 0 > 0.5) seen[key] = 1; if ($1 + 0 == 0) rest[key] = 1 }
    END { for (k in seen) n++; for (k in rest) m++; exit n != 3 || m != 3 }' "$work/out"
noh speak 'I really love to dance, but today, I am tired.'
check 'in words' grep -Eq '^face: [1-9][0-9]* stresses .* [1-9][0-9]* pauses blink$' "$work/out"
noh render "$build/mask.noh" -o "$work/x.png" --face maybe
expect 2 '--face takes on or off'
noh render "$build/mask.noh" -o "$work/x.png" --face on --feel hunger=1
expect 2 'unknown emotion'
cp "$work/line.noh" "$work/first.noh"
noh speak 'Papa bought me five boats.' --face "$build/mask.noh" -o "$work/line.noh"
check 'the same bytes every time' cmp "$work/line.noh" "$work/first.noh"
noh render "$build/mask.noh" --size 64x64 -o "$work/rest.png"
noh render "$build/mask.noh" --size 64x64 -o "$work/open.png" --anim "$work/line.noh" --clip speech --time 0.15
expect 0 'it plays on the mask'
check 'and moves it' sh -c '! cmp -s "$1" "$2"' - "$work/rest.png" "$work/open.png"

noh speak 'Guten Morgen.' --lang de
expect 0 'in German'
noh speak 'Hello' --lang no-such-language
expect 1 'an unknown language'
says 'no-such-language'
noh speak '...'
expect 1 'nothing to say'
noh speak 'Hello' --face "$work/speech.json" -o "$work/other.noh"
expect 1 'a face that is no pack'
check 'leaves nothing behind' sh -c '! test -e "$1"' - "$work/other.noh"
noh speak 'Hello' --face "$build/demo/coat.noh" -o "$work/other.noh"
expect 1 'a pack without a mouth'
says 'no mouth targets'
finish
