#!/bin/sh
# noh build of an .fbx file: axes, unit, skin, shape and animation of a strip written here, compared with
# expected values; truncated files and files of another kind.
. "$(dirname "$0")/lib.sh"

# A strip of two quads, two inches tall in a file whose Z is up: the lower joint holds its foot, the upper one, at half
# its height, the top. In a second the upper joint turns by a quarter about X, and the shape "tall" lifts the top by one.
cat >"$work/strip.fbx" <<'FBX'
; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
	Creator: "a test"
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",2
		P: "UpAxisSign", "int", "Integer", "",1
		P: "FrontAxis", "int", "Integer", "",1
		P: "FrontAxisSign", "int", "Integer", "",-1
		P: "CoordAxis", "int", "Integer", "",0
		P: "CoordAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",2.54
	}
}
Objects:  {
	Geometry: 100, "Geometry::strip", "Mesh" {
		Vertices: *18 {
			a: 0,0,0,1,0,0,0,0,1,1,0,1,0,0,2,1,0,2
		}
		PolygonVertexIndex: *8 {
			a: 0,1,3,-3,2,3,5,-5
		}
		GeometryVersion: 124
		LayerElementMaterial: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {
				a: 0
			}
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}
		}
	}
	Geometry: 110, "Geometry::tall", "Shape" {
		Version: 100
		Indexes: *2 {
			a: 4,5
		}
		Vertices: *6 {
			a: 0,0,1,0,0,1
		}
		Normals: *6 {
			a: 0,0,0,0,0,0
		}
	}
	Model: 200, "Model::strip", "Mesh" {
		Version: 232
	}
	Model: 210, "Model::foot", "LimbNode" {
		Version: 232
	}
	Model: 220, "Model::top", "LimbNode" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",0,0,1
		}
	}
	Material: 300, "Material::cloth", "" {
		Version: 102
		ShadingModel: "phong"
		Properties70:  {
			P: "DiffuseColor", "Color", "", "A",0.5,0.25,1
		}
	}
	Deformer: 400, "Deformer::", "Skin" {
		Version: 101
	}
	Deformer: 410, "SubDeformer::", "Cluster" {
		Version: 100
		Indexes: *4 {
			a: 0,1,2,3
		}
		Weights: *4 {
			a: 1,1,0.5,0.5
		}
		Transform: *16 {
			a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1
		}
		TransformLink: *16 {
			a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1
		}
	}
	Deformer: 420, "SubDeformer::", "Cluster" {
		Version: 100
		Indexes: *4 {
			a: 2,3,4,5
		}
		Weights: *4 {
			a: 0.5,0.5,1,1
		}
		Transform: *16 {
			a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,-1,1
		}
		TransformLink: *16 {
			a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,1,1
		}
	}
	Deformer: 430, "Deformer::shapes", "BlendShape" {
		Version: 100
	}
	Deformer: 440, "SubDeformer::shapes.tall", "BlendShapeChannel" {
		Version: 100
		DeformPercent: 0
		FullWeights: *1 {
			a: 100
		}
	}
	AnimationStack: 500, "AnimStack::bow", "" {
		Properties70:  {
			P: "LocalStop", "KTime", "Time", "",46186158000
			P: "ReferenceStop", "KTime", "Time", "",46186158000
		}
	}
	AnimationLayer: 510, "AnimLayer::base", "" {
	}
	AnimationCurveNode: 520, "AnimCurveNode::R", "" {
		Properties70:  {
			P: "d|X", "Number", "", "A",0
			P: "d|Y", "Number", "", "A",0
			P: "d|Z", "Number", "", "A",0
		}
	}
	AnimationCurve: 530, "AnimCurve::", "" {
		Default: 0
		KeyVer: 4008
		KeyTime: *2 {
			a: 0,46186158000
		}
		KeyValueFloat: *2 {
			a: 0,90
		}
		KeyAttrFlags: *1 {
			a: 1032
		}
		KeyAttrDataFloat: *4 {
			a: 0,0,0,0
		}
		KeyAttrRefCount: *1 {
			a: 2
		}
	}
	AnimationCurveNode: 540, "AnimCurveNode::DeformPercent", "" {
		Properties70:  {
			P: "d|DeformPercent", "Number", "", "A",0
		}
	}
	AnimationCurve: 550, "AnimCurve::", "" {
		Default: 0
		KeyVer: 4008
		KeyTime: *2 {
			a: 0,46186158000
		}
		KeyValueFloat: *2 {
			a: 0,100
		}
		KeyAttrFlags: *1 {
			a: 1032
		}
		KeyAttrDataFloat: *4 {
			a: 0,0,0,0
		}
		KeyAttrRefCount: *1 {
			a: 2
		}
	}
}
Connections:  {
	C: "OO",200,0
	C: "OO",210,0
	C: "OO",220,210
	C: "OO",100,200
	C: "OO",300,200
	C: "OO",400,100
	C: "OO",410,400
	C: "OO",420,400
	C: "OO",210,410
	C: "OO",220,420
	C: "OO",430,100
	C: "OO",440,430
	C: "OO",110,440
	C: "OO",510,500
	C: "OO",520,510
	C: "OO",540,510
	C: "OP",520,220, "Lcl Rotation"
	C: "OP",530,520, "d|X"
	C: "OP",540,440, "DeformPercent"
	C: "OP",550,540, "d|DeformPercent"
}
FBX

noh build "$work/strip.fbx" -o "$work/strip.noh"
expect 0 'a strip with a skin, a shape and a clip'
said() { grep -q "$1" "$work/out" "$work/err"; }
check 'corners that are alike are one vertex' said "mesh 'strip': 6 vertices, 4 triangles, 1 submeshes, 1 targets"
check 'the clip has its name' said "clip 'bow'"
noh verify "$work/strip.noh"
expect 0 'verified'
noh info "$work/strip.noh"
check 'the target has the name behind its deformer' grep -qw tall "$work/out"

# What stands at the ends of the strip, in thousandths of an inch to the next 50 (a clip is within 0.1 mm), Y up.
ends() {
    noh dump "$work/strip.noh" -o "$work/strip.obj" "$@"
    awk '/^v / { printf "%.0f %.0f %.0f\n", $2 / 0.0000254, $3 / 0.0000254, $4 / 0.0000254 }' "$work/strip.obj" |
        sed 's/-0\b/0/g' | awk '{ for (i = 1; i <= 3; i++) $i = int(($i + ($i < 0 ? -25 : 25)) / 50) * 50; print }' | sort -n | tr '\n' ';'
}
stands() { # NAME ENDS OPTIONS
    name=$1 want=$2
    shift 2
    got=$(ends "$@")
    check "$name" test "$got" = "$want"
    [ "$got" = "$want" ] || echo "# $got not $want"
}
stands 'at rest it is two inches tall, Y up' '0 0 0;0 1000 0;0 2000 0;1000 0 0;1000 1000 0;1000 2000 0;'
stands 'the shape lifts its top' '0 0 0;0 1000 0;0 3000 0;1000 0 0;1000 1000 0;1000 3000 0;' --weight tall=1
stands 'at the end of the clip the top, lifted, lies forward' '0 0 0;0 1000 0;0 1000 2000;1000 0 0;1000 1000 0;1000 1000 2000;' --clip bow --time 0.99999

# ---- the same file with other details ----

changed() { # SED: $work/strip.noh from the changed file
    LC_ALL=C sed "$1" "$work/strip.fbx" >"$work/changed.fbx"
    noh build "$work/changed.fbx" -o "$work/strip.noh"
}
changed 's|^\(.*"Lcl Translation", "Lcl Translation".*\)|\1\
			P: "RotationPivot", "Vector3D", "Vector", "",0,0,0.5|'
expect 0 'a joint with a pivot'
stands 'it turns about its pivot' '0 0 0;0 1250 -250;0 1500 1500;1000 0 0;1000 1250 -250;1000 1500 1500;' --clip bow --time 0.99999

changed 's|"LocalStop", "KTime", "Time", "",46186158000|"LocalStop", "KTime", "Time", "",23093079000|'
expect 0 'a take of half of the keys'
check 'the clip has its length' said "clip 'bow': 13 frames"

changed 's|a: 100$|a: 100,0|; s|FullWeights: \*1|FullWeights: *2|'
expect 0 'a shape with a mask'
stands 'it moves what its mask lets through' '0 0 0;0 1000 0;0 3000 0;1000 0 0;1000 1000 0;1000 2000 0;' --weight tall=1

changed 's|DeformPercent: 0|DeformPercent: 50|'
expect 0 'a shape with a percentage'
stands 'it is half up at rest' '0 0 0;0 1000 0;0 2500 0;1000 0 0;1000 1000 0;1000 2500 0;'

changed 's|"Model::top"|"Model::strip"|'
expect 0 'a joint with the name of the mesh'
stands 'it moves the mesh' '0 0 0;0 1000 0;0 1000 2000;1000 0 0;1000 1000 0;1000 1000 2000;' --clip bow --time 0.99999

bytes=$(printf '\223\252')
changed "s|\"Model::top\"|\"Model::$bytes\"|"
expect 0 'a name that is not UTF-8'
check 'its bytes are replaced' said "the name '_93_AA' had bytes that are not UTF-8"

changed 's|^\(.*Deformer: 400.*\)|\1\
		SkinningType: "DualQuaternion"|'
expect 0 'a skin of dual quaternions'
check 'it is warned of' said 'dual quaternion'

noh build "$work/strip.fbx" -o "$work/strip.noh" --unit-cm 5.08 --quiet
expect 0 'with another unit'
stands 'it is twice as large' '0 0 0;0 2000 0;0 4000 0;2000 0 0;2000 2000 0;2000 4000 0;'

# ---- what is refused ----

head -n 60 "$work/strip.fbx" >"$work/cut.fbx"
noh build "$work/cut.fbx" -o "$work/x.noh"
expect 1 'a file that is cut'
says 'cut.fbx'
echo 'no FBX' >"$work/none.fbx"
noh build "$work/none.fbx" -o "$work/x.noh"
expect 1 'a file that is no FBX'
noh build "$work/nowhere.fbx" -o "$work/x.noh"
expect 1 'a file that is not there'
check 'and no pack' test ! -f "$work/x.noh"

# Changed and truncated files give a pack or a message: in the short form twelve, with NOH_LONG=1 also thirty of each of
# Debian's test files.
models=/usr/share/assimp/models/FBX
seed=1 broken=0 tried=0
next_random() { # BELOW: $random
    seed=$(((seed * 1103515245 + 12345) % 2147483648))
    random=$((seed / 64 % $1))
}
damage() { # FILE: damaged in one to three places, in one of four also cut, as $work/damaged.fbx
    cp "$1" "$work/damaged.fbx"
    size=$(wc -c <"$1")
    next_random 3
    for place in $(seq 0 "$random"); do
        next_random "$size"
        at=$random
        next_random 256
        # shellcheck disable=SC2059
        printf "\\$(printf '%o' "$random")" |
            dd of="$work/damaged.fbx" bs=1 seek="$at" conv=notrunc 2>/dev/null
    done
    next_random 4
    [ "$random" != 0 ] || { next_random "$size"; head -c "$random" "$work/damaged.fbx" >"$work/cut.fbx"; mv "$work/cut.fbx" "$work/damaged.fbx"; }
}
try_damaged() { # FILE TIMES
    for round in $(seq 1 "$2"); do
        damage "$1"
        rm -f "$work/damaged.noh"
        noh build "$work/damaged.fbx" -o "$work/damaged.noh"
        tried=$((tried + 1))
        case $code in
        0) [ -s "$work/damaged.noh" ] || broken=$((broken + 1)) ;;
        1) grep -q '^noh: ' "$work/err" && [ ! -e "$work/damaged.noh" ] || broken=$((broken + 1)) ;;
        *) broken=$((broken + 1)) && cp "$work/damaged.fbx" "$build/tests/log/damaged_$tried.fbx" ;;
        esac
    done
}
try_damaged "$work/strip.fbx" 12
if [ -n "${NOH_LONG:-}" ]; then
    for file in "$work/strip.fbx" $models/*.fbx $models/*/*.fbx; do
        [ ! -f "$file" ] || try_damaged "$file" 30
    done
fi
check "$tried damaged files" test $broken = 0

if [ -f $models/huesitos.fbx ]; then
    noh build $models/huesitos.fbx -o "$work/bones.noh" --quiet
    expect 0 'a skinned cylinder by Blender'
    noh verify "$work/bones.noh"
    expect 0 'verified too'
    noh build $models/phong_cube.fbx -o "$work/cube.noh"
    expect 0 'a cube by Maya'
    check 'of 24 vertices' said ' 24 vertices, 12 triangles'
else
    skip 'FBX files of others' 'no assimp-testmodels'
fi
finish
