/* Tests of tools/convert/base/names.c and of what uses it: recipes by the names of targets (recipe_make.c), clips by
 * the names of joints (joint_match.c) are in test_sources.c. */
#include "convert/base/names.h"
#include "convert/base/names_table.h"

#include <stdio.h>
#include <string.h>

#include "convert/model/recipe_make.h"
#include "convert/model/recipe_whole.h"
#include "convert/model/surface_kind.h"
#include "noh/face.h"
#include "noh/format.h"
#include "support/support.h"

typedef struct name_case {
    const char *name, *means; /* means NULL: nothing */
} name_case;

static void check_cases(name_kind kind, const name_case *cases, size_t count)
{
    char means[NOH_NAME_BYTES_MAX];
    for (size_t i = 0; i < count; i++) {
        const int found = names_find(kind, cases[i].name, means, NULL);
        if (found != (cases[i].means != NULL) || (found && strcmp(means, cases[i].means) != 0)) {
            fail_msg("'%s' means '%s', and should mean '%s'", cases[i].name, found ? means : "nothing",
                     cases[i].means ? cases[i].means : "nothing");
        }
    }
}

static void targets_have_other_names(void **state)
{
    static const name_case cases[] = {
        { "eyeBlinkLeft", "eyeBlinkLeft" },
        { "eyeBlink_L", "eyeBlinkLeft" },
        { "EyeBlinkRight", "eyeBlinkRight" },
        { "eye_blink_right", "eyeBlinkRight" },
        { "L_eyeBlink", "eyeBlinkLeft" },
        { "Eye_Blink_L", "eyeBlinkLeft" },
        { "Eye_L_Look_Up", "eyeLookUpLeft" },
        { "face_shapes.jawOpen", "jawOpen" },
        { "blendShape1.mouthSmile_R", "mouthSmileRight" },
        { "jawOpen.001", "jawOpen" },
        { "Jaw_Open", "jawOpen" },
        { "Jaw_L", "jawLeft" },
        { "Mouth_Down_Lower_L", "mouthLowerDownLeft" },
        { "Brow_Raise_Inner_R", "browInnerUp" },
        { "Brow_Drop_R", "browDownRight" },
        { "facs_jnt_EyeBlinkLeft", "eyeBlinkLeft" },
        { "facs_bs_MouthSmileLeft_div2", "mouthSmileLeft" },
        { "eCTRLEyesClosedR", "eyeBlinkRight" },
        { "eCTRLvL", "nn" },
        { "eCTRLvAA", "aa" },
        { "head__eCTRLvUW", "ou" },
        { "Genesis8Female__eCTRLvEH", "E" },
        { "viseme_sil", "sil" },
        { "viseme_PP", "PP" },
        { "viseme_FF", "FF" },
        { "viseme_TH", "TH" },
        { "viseme_DD", "DD" },
        { "viseme_kk", "kk" },
        { "viseme_CH", "CH" },
        { "viseme_SS", "SS" },
        { "viseme_nn", "nn" },
        { "viseme_RR", "RR" },
        { "viseme_aa", "aa" },
        { "viseme_E", "E" },
        { "viseme_I", "ih" },
        { "viseme_O", "oh" },
        { "viseme_U", "ou" },
        { "vrc.v_ch", "CH" },
        { "V_Explosive", "PP" },
        { "T_L_D_N", "DD" },
        { "Fcl_MTH_A", "aa" },
        { "Fcl_MTH_I", "ih" },
        { "Fcl_EYE_Close_L", "eyeBlinkLeft" },
        { "Face.M_F00_000_00_Fcl_EYE_Close_R", NULL },
        { "Fcl_ALL_Sorrow", "sadness-upper" },
        { "あ", "aa" },
        { "まばたき", "blink" },
        { "eyeBlink", "blink" },
        { "Fcl_EYE_Close", "blink" },
        { "blendShape1.MTH_A", "aa" },
        { "vrc_v_aa", "aa" },
        { "vrc.blink_left", "eyeBlinkLeft" },
        { "Blink_Right", "eyeBlinkRight" },
        { "EyeClosedLeft", "eyeBlinkLeft" },
        { "eyesClosedR", "eyeBlinkRight" },
        { "eyesClosed", "blink" },
        { "CTRL_expressions_browRaiseInL", "browInnerUp" },
        { "CTRL_expressions_mouthFunnelUL", "mouthFunnel" },
        { "lipCornerPullerR", "mouthSmileRight" },
        { "lipFunnelerLB", "mouthFunnel" },
        { "MouthCornerPullLeft", "mouthSmileLeft" },
        { "Mouth_Sad_Left", "mouthFrownLeft" },
        { "UpperLipUp_Left", "mouthUpperUpLeft" },
        { "Joy", "happy" },
        { "mouthSmile", "smile" },
        { "grin", NULL },
        { "L", NULL },
        { "", NULL },
        { ":", NULL },
        { "...", NULL },
    };
    (void)state;
    check_cases(NAME_TARGET, cases, TEST_COUNT(cases));
}

static void joints_have_other_names(void **state)
{
    static const name_case cases[] = {
        { "hips", "hips" },
        { "mixamorig:Hips", "hips" },
        { "mixamorig7:LeftUpLeg", "leftUpperLeg" },
        { "mixamorig:RightForeArm", "rightLowerArm" },
        { "mixamorig:LeftHandIndex1", "leftIndexProximal" },
        { "mixamorig:LeftToeBase", "leftToes" },
        { "pelvis", "hips" },
        { "spine_03", "upperChest" },
        { "clavicle_l", "leftShoulder" },
        { "upperarm_r", "rightUpperArm" },
        { "calf_l", "leftLowerLeg" },
        { "ball_r", "rightToes" },
        { "thumb_01_l", "leftThumbMetacarpal" },
        { "FACIAL_L_Eye", "leftEye" },
        { "LeftUpperLeg", "leftUpperLeg" },
        { "UpperChest", "upperChest" },
        { "J_Bip_C_Head", "head" },
        { "J_Bip_L_LowerArm", "leftLowerArm" },
        { "J_Adj_R_FaceEye", "rightEye" },
        { "Bip01 R Thigh", "rightUpperLeg" },
        { "Bip001 L Calf", "leftLowerLeg" },
        { "CC_Base_L_Eye", "leftEye" },
        { "CC_Base_NeckTwist01", "neck" },
        { "CC_Base_Spine01", "chest" },
        { "CC_Base_R_Calf", "rightLowerLeg" },
        { "lShldrBend", "leftUpperArm" },
        { "rForearmBend", "rightLowerArm" },
        { "abdomenLower", "spine" },
        { "chestUpper", "upperChest" },
        { "lEye", "leftEye" },
        { "l_thigh", "leftUpperLeg" },
        { "upperarm01.L", "leftUpperArm" },
        { "lowerleg01.R", "rightLowerLeg" },
        { "eye.L", "leftEye" },
        { "DEF-upper_arm.L", "leftUpperArm" },
        { "左腕", "leftUpperArm" },
        { "右足", "rightUpperLeg" },
        { "右足首", "rightFoot" },
        { "上半身2", "chest" },
        { "センター", "hips" },
        { "左目", "leftEye" },
        { "左親指０", "leftThumbMetacarpal" },
        { "右小指３", "rightLittleDistal" },
        { "Chest_M", "chest" },
        { "Scapula_R", "rightShoulder" },
        { "PinkyFinger3_R", "rightLittleDistal" },
        { "mKneeLeft", "leftLowerLeg" },
        { "mHead", "head" },
        { "CATRigLLegThigh", "leftUpperLeg" },
        { "CATRigRArmPalm", "rightHand" },
        { "DEF-f_index.01.L", "leftIndexProximal" },
        { "Oberarm_L", "leftUpperArm" },
        { "UnterschenkelRechts", "rightLowerLeg" },
        { "Hand_Links", "leftHand" },
        { "Fuß_rechts", "rightFoot" },
        { "Kopf", "head" },
        { "左足ＩＫ", NULL },
        { "左足D", NULL },
        { "右腕捩", NULL },
        { "左", NULL },
        { "tail", NULL },
    };
    int is_own = 0;
    char means[NOH_NAME_BYTES_MAX];
    (void)state;
    check_cases(NAME_JOINT, cases, TEST_COUNT(cases));
    assert_true(names_find(NAME_JOINT, "EYE_LEFT", means, &is_own) && is_own);
    assert_true(names_find(NAME_JOINT, "CC_Base_L_Eye", means, &is_own) && !is_own);
}

/* What the table calls a target is a channel or a name that a built-in recipe has, or one of ARKit's others. */
static void every_line_is_read(void **state)
{
    char means[NOH_NAME_BYTES_MAX];
    uint32_t channels = 0;
    (void)state;
    for (uint32_t i = 0; names_table[i]; i++) {
        char first[64], kind[16];
        assert_int_equal(sscanf(names_table[i], "%15s %63s", kind, first), 2);
        if (strcmp(kind, "target") != 0) continue;
        channels += noh_face_channel_find(first) != NOH_NONE;
    }
    assert_int_equal(channels, 20); /* fifteen mouth shapes and five of VRoid */
    for (uint32_t i = 0; i < noh_face_recipe_arkit.row_count; i++) {
        assert_true(names_find(NAME_TARGET, noh_face_recipe_arkit.rows[i].target, means, NULL));
        assert_string_equal(means, noh_face_recipe_arkit.rows[i].target);
    }
}

static void a_file_comes_first(void **state)
{
    static const char text[] = "# ours\ntarget aa Schnabel_Auf\ntarget mouthSmile* Grins_*\njoint head Huvud\n"
                               "material plain tarnhaut\nmaterial skin leder\n";
    char means[NOH_NAME_BYTES_MAX];
    model_error error = { "", "" };
    (void)state;
    test_write_file(test_path("names.txt"), text, sizeof text - 1u);
    assert_int_equal(names_use(test_path("names.txt"), &error), 0);
    assert_true(names_find(NAME_TARGET, "schnabelAuf", means, NULL));
    assert_string_equal(means, "aa");
    assert_true(names_find(NAME_TARGET, "grins.R", means, NULL));
    assert_string_equal(means, "mouthSmileRight");
    assert_true(names_find(NAME_JOINT, "Huvud", means, NULL));
    assert_int_equal(surface_kind_of_name("altes Leder"), NOH_SURFACE_SKIN);
    assert_int_equal(surface_kind_of_name("Skin_Tarnhaut"), NOH_SURFACE_PLAIN);
    names_free();
    assert_int_equal(surface_kind_of_name("Skin_Tarnhaut"), NOH_SURFACE_SKIN);
    assert_false(names_find(NAME_JOINT, "Huvud", means, NULL));
    names_free();
}

static float weight_of(const recipe_text *recipe, const char *channel, const char *target)
{
    for (uint32_t i = 0; i < recipe->count; i++) {
        if (strcmp(recipe->rows[i].channel, channel) == 0 && strcmp(recipe->rows[i].target, target) == 0)
            return recipe->rows[i].weight;
    }
    return 0.0f;
}

static void joints_of_the_face_get_rows(void **state)
{
    static const char *const joints[] = { "CC_Base_Head",    "CC_Base_NeckTwist01", "CC_Base_Spine01",
                                          "CC_Base_Spine02", "CC_Base_L_Eye",       "CC_Base_R_Eye" };
    static const char *const own[] = { "HEAD", "Neck", "mixamorig:Chest", "eye.L", "RightEye", "Spine2" };
    recipe_text *recipe = recipe_new();
    (void)state;
    assert_int_equal(recipe_add_row(recipe, "mine", "joint-neck", 1.0f, 0), 0);
    assert_int_equal(recipe_add_joints(recipe, joints, TEST_COUNT(joints)), 0);
    assert_int_equal(recipe->count, 5);
    assert_true(weight_of(recipe, "joint-neck", "mine") == 1.0f);
    assert_true(weight_of(recipe, "joint-head", "CC_Base_Head") == 1.0f);
    assert_true(weight_of(recipe, "joint-chest", "CC_Base_Spine02") == 1.0f);
    assert_true(weight_of(recipe, "joint-eye-left", "CC_Base_L_Eye") == 1.0f);
    assert_true(weight_of(recipe, "joint-eye-right", "CC_Base_R_Eye") == 1.0f);
    recipe_free(recipe);
    recipe = recipe_new();
    assert_int_equal(recipe_add_joints(recipe, own, TEST_COUNT(own)), 0);
    assert_int_equal(recipe->count, 1); /* the runtime knows the others */
    assert_true(weight_of(recipe, "joint-chest", "Spine2") == 1.0f);
    recipe_free(recipe);
}

/* A face of six numbers: two for brows, two for eyes, two for the mouth. */
#define FACE 6u

typedef struct moved {
    const char *name;
    float by[FACE];
} moved;

static void add_shapes(model *m, model_mesh *mesh, model_target *targets, const moved *shapes, uint32_t count)
{
    memset(m, 0, sizeof *m);
    memset(mesh, 0, sizeof *mesh);
    memset(targets, 0, count * sizeof *targets);
    m->meshes = mesh;
    m->mesh_count = 1;
    mesh->targets = targets;
    mesh->target_count = count;
    mesh->vertex_count = FACE / 3u;
    for (uint32_t i = 0; i < count; i++) {
        targets[i].name = (char *)shapes[i].name;
        targets[i].position = (float *)shapes[i].by;
    }
}

#define SHAPES_MAX 8u

/* The rows of a face whose targets have known names. */
static recipe_text *known_of(const moved *shapes, uint32_t count, uint32_t *rows)
{
    recipe_text *recipe = recipe_new();
    model_target targets[SHAPES_MAX];
    model_mesh mesh;
    model m;
    assert_true(recipe && count <= SHAPES_MAX);
    add_shapes(&m, &mesh, targets, shapes, count);
    assert_int_equal(recipe_add_known(recipe, &m, rows), 0);
    return recipe;
}

/* One shape under two names counts once; sides and parts of a shape add up. */
static void one_shape_of_two_names_counts_once(void **state)
{
    static const moved shapes[] = {
        { "Fcl_MTH_A", { 0, 0, 0, 0, 1.0f, 2.0f } },           { "viseme_aa", { 0, 0, 0, 0, 1.0f, 2.0f } },
        { "Fcl_MTH_O", { 0, 0, 0, 0, 1.1f, 1.9f } },           { "viseme_O", { 0, 0, 0, 0, 1.0f, 2.0f } },
        { "Mouth_Funnel_Up_L", { 0, 0, 0, 0.2f, 1.0f, 0 } },   { "Mouth_Funnel_Up_R", { 0, 0, 0, 1.0f, 0.2f, 0 } },
        { "Mouth_Funnel_Down_L", { 0, 1.0f, 0, 0, 0, 0.1f } }, { "Mouth_Funnel_Down_R", { 1.0f, 0, 0, 0, 0, 0.1f } },
    };
    uint32_t count;
    recipe_text *recipe = known_of(shapes, TEST_COUNT(shapes), &count);
    (void)state;
    assert_true(weight_of(recipe, "aa", "Fcl_MTH_A") == 1.0f);
    assert_true(weight_of(recipe, "aa", "viseme_aa") == 0.0f);
    assert_true(weight_of(recipe, "oh", "Fcl_MTH_O") + weight_of(recipe, "oh", "viseme_O") == 1.0f);
    for (size_t i = 4; i < TEST_COUNT(shapes); i++) assert_true(weight_of(recipe, "CH", shapes[i].name) > 0.0f);
    recipe_free(recipe);
}

/* Names of one file: words that all of them begin with are no part of them; one target may blink both eyes; names of
 * channels are taken as they are. */
static void names_of_a_file_are_read_together(void **state)
{
    static const moved shapes[] = {
        { "F.M_00_Fcl_EYE_Close", { 0, 0, 1, 1, 0, 0 } },
        { "F.M_00_Fcl_MTH_A", { 0, 0, 0, 0, 1, 0 } },
        { "F.M_00_viseme_E", { 0, 0, 0, 0, 0, 1 } },
        { "F.M_00_grin", { 1, 0, 0, 0, 0, 0 } },
    };
    static const moved sides[] = {
        { "blink", { 0, 0, 1, 1, 0, 0 } },         { "eyeBlink_L", { 0, 0, 1, 0, 0, 0 } },
        { "eyeBlink_R", { 0, 0, 0, 1, 0, 0 } },    { "PP", { 0, 0, 0, 0, 1, 0 } },
        { "jawOpen_smile", { 0, 0, 0, 0, 0, 1 } }, /* a corrective */
    };
    uint32_t count;
    recipe_text *recipe = known_of(shapes, TEST_COUNT(shapes), &count);
    (void)state;
    assert_true(weight_of(recipe, "blink-left", "F.M_00_Fcl_EYE_Close") == 1.0f);
    assert_true(weight_of(recipe, "blink-right", "F.M_00_Fcl_EYE_Close") == 1.0f);
    assert_true(weight_of(recipe, "aa", "F.M_00_Fcl_MTH_A") == 1.0f);
    assert_true(weight_of(recipe, "E", "F.M_00_viseme_E") == 1.0f);
    assert_int_equal(count, 4);
    recipe_free(recipe);
    recipe = known_of(sides, TEST_COUNT(sides), &count);
    assert_true(weight_of(recipe, "blink-left", "eyeBlink_L") == 1.0f);
    assert_true(weight_of(recipe, "blink-right", "eyeBlink_R") == 1.0f);
    assert_true(weight_of(recipe, "PP", "PP") == 1.0f);
    for (uint32_t i = 0; i < recipe->count; i++) {
        assert_string_not_equal(recipe->rows[i].target, "blink");
        assert_string_not_equal(recipe->rows[i].target, "jawOpen_smile");
    }
    recipe_free(recipe);
}

/* Letters are vowels where at least three of them are. */
static void letters_are_vowels_together(void **state)
{
    static const moved vowels[] = { { "A", { 1 } }, { "I", { 0, 1 } }, { "U", { 0, 0, 1 } } };
    static const moved variants[] = { { "Variant_A", { 1 } }, { "Variant_B", { 0, 1 } }, { "Variant_E", { 0, 0, 1 } } };
    static const struct {
        const moved *shapes;
        uint32_t rows;
    } cases[] = { { vowels, 3 }, { variants, 0 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        uint32_t count;
        recipe_text *recipe = known_of(cases[i].shapes, 3, &count);
        assert_int_equal(count, cases[i].rows);
        recipe_free(recipe);
    }
}

/* Of targets that move the same way the smallest is used, but no detail of another; a small one holds no chain. */
static void details_stand_for_nothing(void **state)
{
    static const moved shapes[] = {
        { "jawOpen", { 1.0f, 0, 0, 0, 0, 0 } },   { "Mouth_Open", { 0.05f, 0, 0, 0, 0, 0 } },
        { "a", { 0, 1.0f, 0, 0, 0, 0 } },         { "b", { 0, 0.55f, 0, 0, 0, 0 } },
        { "c", { 0, 0.29f, 0, 0, 0, 0 } },        { "b again", { 0, 0.55f, 0, 0, 0, 0 } },
        { "elsewhere", { 0, 0, 0.5f, 0, 0, 0 } }, { "nothing", { 0, 0, 0, 0, 0, 0 } },
        { "alone", { 0, 0.55f, 0, 0, 0, 0 } },
    };
    static const uint32_t meaning[TEST_COUNT(shapes)] = { 0, 0, 2, 2, 2, 2, 2, 2, MODEL_NONE };
    static const uint8_t expected[TEST_COUNT(shapes)] = { 0, 1, 1, 0, 1, 1, 0, 0, 0 };
    const char *names[TEST_COUNT(shapes)];
    model_target targets[TEST_COUNT(shapes)];
    uint8_t held[TEST_COUNT(shapes)];
    model_mesh mesh;
    model m;
    (void)state;
    add_shapes(&m, &mesh, targets, shapes, TEST_COUNT(shapes));
    for (size_t i = 0; i < TEST_COUNT(shapes); i++) names[i] = shapes[i].name;
    assert_int_equal(targets_find_held(&m, names, meaning, TEST_COUNT(shapes), held), 0);
    assert_memory_equal(held, expected, sizeof expected);
}

/* An emotion of the whole face gives its mouth to speech, and its lids to blinks; one that is no sum stays. */
static void whole_faces_take_their_parts(void **state)
{
    static const moved shapes[] = {
        { "F_Fcl_ALL_Joy", { 1, 1, 2, 2, 1, 1 } },   { "F_Fcl_BRW_Joy", { 1, 1, 0, 0, 0, 0 } },
        { "F_Fcl_EYE_Joy", { 0, 0, 2, 2, 0, 0 } },   { "F_Fcl_MTH_Joy", { 0, 0, 0, 0, 1, 1 } },
        { "F_Fcl_ALL_Angry", { 1, 0, 1, 0, 1, 0 } }, { "F_Fcl_BRW_Angry", { 1, 0, 0, 0, 0, 0 } },
        { "F_Fcl_EYE_Angry", { 0, 0, 1, 0, 0, 0 } }, { "F_Fcl_MTH_Angry", { 0, 0, 0, 0, 0, 3 } },
        { "F_Fcl_EYE_Close", { 0, 0, 2, 3, 0, 0 } },
    };
    recipe_text *recipe = recipe_new();
    model_target targets[TEST_COUNT(shapes)];
    model_mesh mesh;
    model m;
    (void)state;
    add_shapes(&m, &mesh, targets, shapes, TEST_COUNT(shapes));
    assert_int_equal(recipe_add_row(recipe, "F_Fcl_ALL_Joy", "anger-upper", 1.0f, 1), 0); /* an artist's own row */
    assert_int_equal(recipe_add_row(recipe, "F_Fcl_ALL_Joy", "joy-upper", 0.5f, 0), 0);
    assert_int_equal(recipe_add_row(recipe, "F_Fcl_ALL_Angry", "fear-upper", 1.0f, 0), 0);
    assert_int_equal(recipe_split_whole(recipe, &m), 0);
    assert_true(weight_of(recipe, "anger-upper", "F_Fcl_ALL_Joy") == 1.0f);
    assert_true(weight_of(recipe, "fear-upper", "F_Fcl_ALL_Angry") == 1.0f);
    assert_true(weight_of(recipe, "joy-upper", "F_Fcl_ALL_Joy") == 0.0f);
    assert_true(weight_of(recipe, "joy-upper", "F_Fcl_BRW_Joy") == 0.5f);
    assert_true(weight_of(recipe, "joy-upper", "F_Fcl_EYE_Joy") == 0.5f);
    assert_true(weight_of(recipe, "joy-mouth", "F_Fcl_MTH_Joy") == 0.5f);
    assert_true(weight_of(recipe, "override-lids", "joy-upper") == (float)NOH_OVERRIDE_BLEND);
    recipe_free(recipe);
}

/* A row in a mesh's extras is its artist's, and is kept as it is; VRM's expressions are split. */
static void rows_of_artists_stay(void **state)
{
    static const moved shapes[] = { { "Fcl_ALL_Joy", { 1, 1, 2, 2, 1, 1 } },
                                    { "Fcl_BRW_Joy", { 1, 1, 0, 0, 0, 0 } },
                                    { "Fcl_EYE_Joy", { 0, 0, 2, 2, 0, 0 } },
                                    { "Fcl_MTH_Joy", { 0, 0, 0, 0, 1, 1 } } };
    model_target targets[TEST_COUNT(shapes)];
    model_mesh mesh;
    model m;
    char lines[] = "joy-upper Fcl_ALL_Joy";
    (void)state;
    add_shapes(&m, &mesh, targets, shapes, TEST_COUNT(shapes));
    mesh.recipe = lines;
    for (int is_made = 0; is_made < 2; is_made++) {
        recipe_text *recipe = recipe_new();
        mesh.recipe_is_made = is_made;
        assert_int_equal(recipe_add_extras(recipe, &m), 0);
        assert_int_equal(recipe_split_whole(recipe, &m), 0);
        assert_true(weight_of(recipe, "joy-upper", "Fcl_ALL_Joy") == (is_made ? 0.0f : 1.0f));
        recipe_free(recipe);
    }
}

static void wrong_lines_are_named(void **state)
{
    static const struct {
        const char *text, *what, *where;
    } cases[] = { { "target aa x\nbone head Kopf\n", "'bone' is none of", "line 2" },
                  { "target\n", "a line is KIND WHAT NAME", "line 1" },
                  { "material skin\n", "a line is KIND WHAT NAME", "line 1" },
                  { "joint head \"Kopf\n", "a quote is not closed", "line 1" } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model_error error = { "", "" };
        test_write_file(test_path("names.txt"), cases[i].text, strlen(cases[i].text));
        assert_int_equal(names_use(test_path("names.txt"), &error), 1);
        if (!strstr(error.what, cases[i].what)) fail_msg("'%s' for '%s'", error.what, cases[i].text);
        assert_string_equal(error.where, cases[i].where);
        names_free();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_have_other_names),
        cmocka_unit_test(joints_have_other_names),
        cmocka_unit_test(every_line_is_read),
        cmocka_unit_test(a_file_comes_first),
        cmocka_unit_test(joints_of_the_face_get_rows),
        cmocka_unit_test(wrong_lines_are_named),
        cmocka_unit_test(one_shape_of_two_names_counts_once),
        cmocka_unit_test(names_of_a_file_are_read_together),
        cmocka_unit_test(letters_are_vowels_together),
        cmocka_unit_test(whole_faces_take_their_parts),
        cmocka_unit_test(details_stand_for_nothing),
        cmocka_unit_test(rows_of_artists_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
