#!/bin/sh
# Figures of the papers, redrawn with what is in the repository: a page that says what each shows.
# Usage: figures.sh PROGRAM SOURCE-DIR OUTPUT-DIR [FIGURE…]; without figures all of them.
set -eu
program=$1 source=$2 out=$3
shift 3
wanted=" $* "
FLUIDY_STYLES=$source/fixtures/styles
export FLUIDY_STYLES
mkdir -p "$out/turning"
snowman=$source/fixtures/animations/snowman-wave-layers

# A blob with five lobes that turns by three degrees a frame.
svg='<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 200">'
for f in $(seq 1 24); do
    printf '%s<g transform="rotate(%d 100 100)"><path id="blob" fill="#d06030" d="M100 15C125 15 120 45 145 50C185 55 195 85 170 105C150 120 175 150 150 170C130 185 115 160 95 170C60 185 35 165 45 135C50 115 15 105 20 80C28 50 55 65 65 45C72 28 80 15 100 15Z"/></g></svg>\n' \
        "$svg" $((3 * f)) >"$out/turning/$(printf %04d.svg "$f")"
done

# A puff that rises from a resting foot and swells.
mkdir -p "$out/puff"
for f in $(seq 1 24); do
    r=$((16 + f)) y=$((150 - 4 * f))
    printf '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 200"><path id="puff" fill="#505868" d="M85 190L90 %dL110 %dL115 190ZM%d %da%d %d 0 1 1 %d 0a%d %d 0 1 1 %d 0Z"/></svg>\n' \
        $y $y $((100 - r)) $y $r $((r * 3 / 4)) $((2 * r)) $r $((r * 3 / 4)) $((-2 * r)) >"$out/puff/$(printf %04d.svg "$f")"
done

page=$out/index.html
cat >"$page" <<END
<!doctype html>
<meta charset="utf-8">
<title>Figures of the papers, redrawn</title>
<style>body { max-width: 70em; margin: 2em auto; font-family: sans-serif } img { max-width: 100% }</style>
<h1>Figures of the papers, redrawn</h1>
<p>By <code>meson test --benchmark figures</code>, from drawings and styles of the repository. Each
sheet has three frames and, of more than four, the middle line of all frames, time downwards.</p>
END

width=200
# figure NAME TITLE WORDS METHODS ARGUMENTS…
figure() {
    name=$1 title=$2 words=$3 methods=$4
    shift 4
    case $wanted in *" $name "* | '  ') ;; *) return ;; esac
    "$program" "$@" --methods "$methods" --width "$width" --paper none --overwrite -q -o "$out/$name.png"
    printf '<h2>%s</h2>\n<p>%s <a href="%s.html">What each row is.</a></p>\n<img src="%s.png" alt="">\n' \
        "$title" "$words" "$name" "$name" >>"$page"
}

still="--tint keep --style-by-page off --style-scale .4 --motion auto --fluid none"
# shellcheck disable=SC2086 # options
{
    figure uniformity 'LazyFluids, figures 2 and 13: uniformity' \
        'Nearest neighbours (w-uni 0) choose few patches, the smooth ones, and the picture washes out; with every patch used equally often the contrast stays, first frame to last.' \
        lazyfluids,lazyfluids:w-uni=0,lazyfluids-steady "$out/turning" -s 15 $still
    figure water 'LazyFluids, figure 10: another still' \
        'The same drawing with water: the net turns with the blob. In the slice lines run upright at the middle, which is the axis, and slant towards the sides.' \
        lazyfluids,lazyfluids-steady "$out/turning" -s 17 $still
    figure coherence 'LazyFluids, section 4.4: the temporal term' \
        'Every level begins with the carried picture, so that even without the term (w-temp 0, unlike in the paper) texture follows the drawing, and changes faster on its way; more of it holds the texture more firmly: fewer breaks in the slice.' \
        lazyfluids-steady:w-temp=0,lazyfluids-steady:w-temp=0.2,lazyfluids-steady:w-temp=1 "$out/turning" -s 15 $still
    figure video 'LazyFluids, figure 11: a still against a recording' \
        'In the first row one frame of the recording is the exemplar: a hole stays on the blob, and turns with it, as the light line through the slice shows. In the second row the recording plays on: holes come and go, and no line runs through.' \
        lazyfluids-steady:style-start=20:style-frames=1,lazyfluids-steady:style-start=16 "$out/turning" -s 02 --tint keep --style-by-page off --style-scale .5
    figure turns 'LazyFluids, figure 8: quarter turns' \
        'With one orientation only (rotate off) a rim is right where the exemplar has one that faces the same way. This exemplar is a disc, which has them all: little changes, and what does is the direction of the net.' \
        lazyfluids-steady,lazyfluids-steady:rotate=off "$out/turning" -s 17 $still -f 1-6
    figure blur 'LazyFluids, figure 9: motion blur' \
        'The output is blurred along its motion while the shutter is open, none at the middle and most at the rim; the next frame comes from the sharp one.' \
        lazyfluids-steady,lazyfluids-steady:motion-blur=1,lazyfluids-steady:motion-blur=2 "$out/turning" -s 15 $still -f 1-6
    figure fluid 'A fluid inside the outline, which none of the papers has' \
        'With the fluid of smoke, first row, threads rise through the stem and roll up to both sides in the cap. Without a fluid paint knows the outline alone: what is in the cap grows with it, and the stem lags behind.' \
        lazyfluids-steady:fluid=smoke,lazyfluids-steady:fluid=none "$out/puff" -s 16
    figure transport 'Transport: ink that moves, and is never made or lost' \
        'First row: the ink before it moves, a flat fill. Second row: it has become the picture of the style, which rides on the outline. Third row: a fluid carries that picture, and draws it out into rolls.' \
        transport:strength=0:fluid=none,transport:fluid=none,transport:fluid=smoke "$out/puff" -s 14 --wash 0 --front 0 --stain 0 --hue 0
    width=240 # the presets of the papers count in pixels: a border of 30 px must leave an interior
    figure ablation 'Fluidymation, the seven terms of the energy' \
        'First row: all terms. Without texture the first frame is a heap of patches that do not fit, with a blurred rim; later frames get theirs by the temporal term. Without the boundary term rims are cut smooth, and fringes and holes lie anywhere. Without direction, and without turning patches into it, fringes point anywhere and rims fray. Without extents little changes here. Without the temporal term the slice breaks into steps: every frame has another texture. Without uniformity few patches are used, and the middle is flat.' \
        fluidymation,fluidymation:w-texture=0,fluidymation:w-bound=0,fluidymation:w-dir=0,fluidymation:rotate=off,fluidymation:w-ext=0,fluidymation:w-temp=0,fluidymation:w-uni=0 \
        "$out/turning" -s 02 -f 1-5
    width=1000
    figure fluidymation 'Fluidymation, section 4: comparison with LazyFluids' \
        'Both see masks only, and the recording as it is, which LazyFluids plays in step with the film. The recording begins with a drop: where its frame has little paint, LazyFluids must show all of it equally often. Fluidymation chooses frames by how far the paint has spread.' \
        fluidymation,lazyfluids "$snowman" -s 02 -f 1-3 --motion masks
}
echo "figures: $page"
