#!/bin/sh
# pictures.sh BUILD [WORD...]: draw the pictures of the documents that show the demo's packs, or of these the ones
# with one of the words in their names. `make pictures` calls it after a change of what is drawn. ImageMagick joins what
# several commands draw, and pngquant leaves a picture 256 colours, a third of its bytes.
set -eu
cd "$(dirname "$0")/../.."
build=$1
shift
noh=$build/noh
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

for program in convert pngquant; do
    command -v $program >/dev/null 2>&1 || { echo "pictures.sh needs $program (Debian: imagemagick, pngquant)"; exit 1; }
done

wanted() {
    [ -n "$words" ] || return 0
    for word in $words; do case $1 in *"$word"*) return 0 ;; esac; done
    return 1
}
words=$*

keep() { # FILE: what was drawn
    pngquant --quality 70-100 --speed 1 --strip --force --output "$1" "$scratch/one.png"
    echo "  $1"
}
picture() { # FILE VERB PACK OPTION...
    file=$1 verb=$2 pack=$build/$3
    shift 3
    wanted "$file" || return 0
    "$noh" "$verb" "$pack" -o "$scratch/one.png" "$@" >/dev/null
    keep "$file"
}
joined() { # FILE PACK OPTIONS OPTIONS...: noh render with each of the options, from left to right
    file=$1 pack=$build/$2 n=0
    shift 2
    wanted "$file" || return 0
    for options in "$@"; do
        n=$((n + 1))
        # shellcheck disable=SC2086 # several words
        "$noh" render "$pack" -o "$scratch/$n.png" $options >/dev/null
    done
    convert "$scratch"/[1-9].png -alpha off +append "$scratch/one.png"
    rm -f "$scratch"/[1-9].png
    keep "$file"
}

guide=tools/docs/guide/pictures assets=tools/demo_assets
picture $assets/nell/faces.png sheet demo/nell.noh --target smile --target surprise --target blink --target viseme_aa \
    --columns 5 --tile 288
picture $guide/faces.png sheet demo/nell.noh --target smile --target anger --target surprise --columns 4 --tile 180
picture $assets/mask/faces.png sheet mask.noh --target smile --target surprise --target anger --target blink \
    --columns 5 --tile 288 --camera 14,4
picture $assets/mask/levels.png sheet mask_levels.noh --lods --target smile --tile 168
picture tools/noh/sheet/wrinkles.png sheet mask.noh --wrinkles --light room --target anger --target smile \
    --target surprise --target browInnerUp
picture $guide/levels.png sheet demo/puppet_levels.noh --lods --target smile --tile 180
picture $guide/walk.png sheet demo/puppet.noh --clip walk --tiles 6 --columns 6 --tile 150 --camera 50,8
picture $guide/fall.png sheet demo/puppet_falls.noh --clip walk --push 0,0,-150 --camera 50,12 --tiles 10 --columns 5 \
    --tile 150
picture $assets/puppet/dance.png sheet demo/puppet.noh --clip dance --camera 25,4 --tiles 12 --columns 6 --tile 240
picture $assets/puppet/fall.png sheet demo/puppet_falls.noh --clip walk --push 0,0,-150 --camera 50,12 --tiles 16 \
    --columns 8 --tile 180
picture tools/noh/sheet/stairs.png sheet demo/puppet_levels.noh --clip walk --tiles 6 --columns 6 --tile 256 \
    --ground stairs --look-at 1.2,2.2,4 --camera 62,12
joined tools/noh/render/lights.png mask.noh '--light studio --weight smile=0.6 --camera 20,4 --size 300x300' \
    '--light room --weight smile=0.6 --camera 20,4 --size 300x300' '--light sky --weight smile=0.6 --camera 20,4 --size 300x300'
blob='--clip dance --time 0.8 --camera 30,15 --size 250x300 --shadow'
joined tools/noh/render/blob.png demo/puppet_levels.noh "$blob off" "$blob blob"
wig='--camera 50,10,1 --size 300x400'
joined $assets/mask/wig.png wig.noh "$wig" "$wig --turn 400 --swing 0.6" "$wig --wind 5,1,-2"
