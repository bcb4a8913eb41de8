/* Names of joints that many programs give: the bodies of a ragdoll (ragdoll_names.c), on which feet and arms depend,
 * and the bones of a person (bone_names.c). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/name_internal.h"
#include "noh/body.h"
#include "noh/low_motion.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/pack.h"
#include "support/support.h"

#define JOINTS_MAX NOH_JOINTS_MAX

/* Joints, parents first: depth, name and what it is. P pelvis, S spine, C chest, N neck or head; limbs u upper arm, e
 * forearm, w hand, t thigh, k shin, f foot, left in small letters and right in capitals; - nothing. */
typedef struct rig {
    const char *program, *joints;
} rig;

static const rig rigs[] = {
    { "Mixamo, the second figure of a scene",
      "0 mixamorig1:Hips P|1 mixamorig1:Spine S|2 mixamorig1:Spine1 -|3 mixamorig1:Spine2 C|4 mixamorig1:Neck N|"
      "5 mixamorig1:Head -|6 mixamorig1:HeadTop_End -|4 mixamorig1:LeftShoulder -|5 mixamorig1:LeftArm u|"
      "6 mixamorig1:LeftForeArm e|7 mixamorig1:LeftHand w|8 mixamorig1:LeftHandIndex1 -|"
      "4 mixamorig1:RightShoulder -|5 mixamorig1:RightArm U|6 mixamorig1:RightForeArm E|7 mixamorig1:RightHand W|"
      "1 mixamorig1:LeftUpLeg t|2 mixamorig1:LeftLeg k|3 mixamorig1:LeftFoot f|4 mixamorig1:LeftToeBase -|"
      "1 mixamorig1:RightUpLeg T|2 mixamorig1:RightLeg K|3 mixamorig1:RightFoot F|4 mixamorig1:RightToeBase -" },
    { "MotionBuilder and Maya's HumanIK",
      "0 Character1_Reference -|1 Character1_Hips P|2 Character1_LeftUpLeg t|3 Character1_LeftLeg k|"
      "4 Character1_LeftFoot f|5 Character1_LeftToeBase -|2 Character1_RightUpLeg T|3 Character1_RightLeg K|"
      "4 Character1_RightFoot F|2 Character1_Spine S|3 Character1_Spine1 C|4 Character1_LeftShoulder -|"
      "5 Character1_LeftArm u|6 Character1_LeftForeArm e|7 Character1_LeftHand w|4 Character1_RightShoulder -|"
      "5 Character1_RightArm U|6 Character1_RightForeArm E|7 Character1_RightHand W|4 Character1_Neck N|"
      "5 Character1_Head -" },
    { "Unreal", "0 root -|1 pelvis P|2 spine_01 S|3 spine_02 -|4 spine_03 C|5 clavicle_l -|6 upperarm_l u|"
                "7 lowerarm_l e|8 hand_l w|9 index_01_l -|8 lowerarm_twist_01_l -|7 upperarm_twist_01_l -|"
                "5 clavicle_r -|6 upperarm_r U|7 lowerarm_r E|8 hand_r W|5 neck_01 N|6 head -|2 thigh_l t|"
                "3 calf_l k|4 calf_twist_01_l -|4 foot_l f|5 ball_l -|3 thigh_twist_01_l -|2 thigh_r T|3 calf_r K|"
                "4 foot_r F|1 ik_foot_root -|2 ik_foot_l -|2 ik_foot_r -|1 ik_hand_root -|2 ik_hand_l -" },
    { "3ds Max's biped, whose arms hang from the neck",
      "0 Bip01 -|1 Bip01 Pelvis P|2 Bip01 Spine S|3 Bip01 Spine1 -|4 Bip01 Neck C|5 Bip01 Head N|6 Bip01 HeadNub -|"
      "5 Bip01 L Clavicle -|6 Bip01 L UpperArm u|7 Bip01 L Forearm e|8 Bip01 L Hand w|9 Bip01 L Finger0 -|"
      "5 Bip01 R Clavicle -|6 Bip01 R UpperArm U|7 Bip01 R Forearm E|8 Bip01 R Hand W|2 Bip01 L Thigh t|"
      "3 Bip01 L Calf k|4 Bip01 L Foot f|5 Bip01 L Toe0 -|2 Bip01 R Thigh T|3 Bip01 R Calf K|4 Bip01 R Foot F" },
    { "Source", "0 ValveBiped.Bip01_Pelvis P|1 ValveBiped.Bip01_Spine S|2 ValveBiped.Bip01_Spine4 C|"
                "3 ValveBiped.Bip01_Neck1 N|4 ValveBiped.Bip01_Head1 -|3 ValveBiped.Bip01_L_Clavicle -|"
                "4 ValveBiped.Bip01_L_UpperArm u|5 ValveBiped.Bip01_L_Forearm e|6 ValveBiped.Bip01_L_Hand w|"
                "5 ValveBiped.Bip01_L_Bicep -|3 ValveBiped.Bip01_R_Clavicle -|4 ValveBiped.Bip01_R_UpperArm U|"
                "5 ValveBiped.Bip01_R_Forearm E|6 ValveBiped.Bip01_R_Hand W|1 ValveBiped.Bip01_L_Thigh t|"
                "2 ValveBiped.Bip01_L_Calf k|3 ValveBiped.Bip01_L_Foot f|4 ValveBiped.Bip01_L_Toe0 -|"
                "1 ValveBiped.Bip01_R_Thigh T|2 ValveBiped.Bip01_R_Calf K|3 ValveBiped.Bip01_R_Foot F" },
    { "Character Creator",
      "0 CC_Base_BoneRoot -|1 CC_Base_Hip P|2 CC_Base_Pelvis -|3 CC_Base_L_Thigh t|4 CC_Base_L_Calf k|"
      "5 CC_Base_L_Foot f|6 CC_Base_L_ToeBase -|5 CC_Base_L_CalfTwist01 -|5 CC_Base_L_KneeShareBone -|"
      "4 CC_Base_L_ThighTwist01 -|3 CC_Base_R_Thigh T|4 CC_Base_R_Calf K|5 CC_Base_R_Foot F|2 CC_Base_Waist S|"
      "3 CC_Base_Spine01 -|4 CC_Base_Spine02 C|5 CC_Base_NeckTwist01 N|6 CC_Base_NeckTwist02 -|7 CC_Base_Head -|"
      "5 CC_Base_L_Clavicle -|6 CC_Base_L_Upperarm u|7 CC_Base_L_Forearm e|8 CC_Base_L_ElbowShareBone -|"
      "8 CC_Base_L_Hand w|7 CC_Base_L_UpperarmTwist01 -|5 CC_Base_R_Clavicle -|6 CC_Base_R_Upperarm U|"
      "7 CC_Base_R_Forearm E|8 CC_Base_R_Hand W" },
    { "Daz Genesis 8",
      "0 hip P|1 pelvis -|2 lThighBend t|3 lThighTwist -|4 lShin k|5 lFoot f|6 lMetatarsals -|7 lToe -|"
      "2 rThighBend T|3 rThighTwist -|4 rShin K|5 rFoot F|1 abdomenLower S|2 abdomenUpper -|"
      "3 chestLower -|4 chestUpper C|5 lCollar -|6 lShldrBend u|7 lShldrTwist -|8 lForearmBend e|"
      "9 lForearmTwist -|10 lHand w|11 lThumb1 -|5 rCollar -|6 rShldrBend U|7 rShldrTwist -|"
      "8 rForearmBend E|9 rForearmTwist -|10 rHand W|5 neckLower N|6 neckUpper -|7 head -" },
    { "Daz Genesis 9",
      "0 hip P|1 pelvis -|2 l_thigh t|3 l_thightwist1 -|3 l_shin k|4 l_foot f|5 l_toes -|2 r_thigh T|"
      "3 r_shin K|4 r_foot F|1 spine1 S|2 spine2 -|3 spine3 -|4 spine4 C|5 l_shoulder -|6 l_upperarm u|"
      "7 l_upperarmtwist1 -|7 l_forearm e|8 l_hand w|5 r_shoulder -|6 r_upperarm U|7 r_forearm E|"
      "8 r_hand W|5 neck1 N|6 neck2 -|7 head -" },
    { "Rigify", "0 DEF-spine P|1 DEF-pelvis.L -|1 DEF-thigh.L t|2 DEF-thigh.L.001 -|3 DEF-shin.L k|4 DEF-shin.L.001 -|"
                "5 DEF-foot.L f|6 DEF-toe.L -|1 DEF-thigh.R T|2 DEF-thigh.R.001 -|3 DEF-shin.R K|4 DEF-shin.R.001 -|"
                "5 DEF-foot.R F|1 DEF-spine.001 S|2 DEF-spine.002 -|3 DEF-spine.003 C|4 DEF-neck N|5 DEF-head -|"
                "6 DEF-forehead.L -|4 DEF-shoulder.L -|5 DEF-upper_arm.L u|6 DEF-upper_arm.L.001 -|7 DEF-forearm.L e|"
                "8 DEF-forearm.L.001 -|9 DEF-hand.L w|4 DEF-shoulder.R -|5 DEF-upper_arm.R U|6 DEF-upper_arm.R.001 -|"
                "7 DEF-forearm.R E|8 DEF-forearm.R.001 -|9 DEF-hand.R W" },
    { "MakeHuman",
      "0 root -|1 spine05 P|2 spine04 S|3 spine03 -|4 spine02 -|5 spine01 C|6 neck01 N|7 head -|6 clavicle.L -|"
      "7 shoulder01.L -|8 upperarm01.L u|9 upperarm02.L -|10 lowerarm01.L e|11 lowerarm02.L -|12 wrist.L w|"
      "13 finger1-1.L -|6 clavicle.R -|7 shoulder01.R -|8 upperarm01.R U|9 upperarm02.R -|"
      "10 lowerarm01.R E|11 lowerarm02.R -|12 wrist.R W|2 pelvis.L -|3 upperleg01.L t|4 upperleg02.L -|"
      "5 lowerleg01.L k|6 lowerleg02.L -|7 foot.L f|8 toe1-1.L -|2 pelvis.R -|3 upperleg01.R T|"
      "4 upperleg02.R -|5 lowerleg01.R K|6 lowerleg02.R -|7 foot.R F" },
    { "CMU's motion as BVH", "0 Hips P|1 LHipJoint -|2 LeftUpLeg t|3 LeftLeg k|4 LeftFoot f|5 LeftToeBase -|"
                             "1 RHipJoint -|2 RightUpLeg T|3 RightLeg K|4 RightFoot F|1 LowerBack S|2 Spine -|"
                             "3 Spine1 C|4 Neck N|5 Neck1 -|6 Head -|4 LeftShoulder -|5 LeftArm u|6 LeftForeArm e|"
                             "7 LeftHand w|8 LeftFingerBase -|4 RightShoulder -|5 RightArm U|6 RightForeArm E|"
                             "7 RightHand W" },
    { "CMU's motion as ASF",
      "0 root P|1 lhipjoint -|2 lfemur t|3 ltibia k|4 lfoot f|5 ltoes -|1 rhipjoint -|2 rfemur T|"
      "3 rtibia K|4 rfoot F|1 lowerback S|2 upperback -|3 thorax C|4 lowerneck N|5 upperneck -|"
      "6 head -|4 lclavicle -|5 lhumerus u|6 lradius e|7 lwrist w|8 lhand -|4 rclavicle -|"
      "5 rhumerus U|6 rradius E|7 rwrist W" },
    { "SMPL", "0 Pelvis P|1 L_Hip t|2 L_Knee k|3 L_Ankle f|4 L_Foot -|1 R_Hip T|2 R_Knee K|3 R_Ankle F|4 R_Foot -|"
              "1 Spine1 S|2 Spine2 -|3 Spine3 C|4 Neck N|5 Head -|4 L_Collar -|5 L_Shoulder u|6 L_Elbow e|7 L_Wrist w|"
              "8 L_Hand -|4 R_Collar -|5 R_Shoulder U|6 R_Elbow E|7 R_Wrist W" },
    { "AdvancedSkeleton",
      "0 Root_M P|1 Hip_R T|2 HipPart1_R -|3 HipPart2_R -|4 Knee_R K|5 KneePart1_R -|6 KneePart2_R -|7 Ankle_R F|"
      "8 Toes_R -|1 RootPart1_M S|2 Spine1_M -|3 Chest_M C|4 Scapula_R -|5 Shoulder_R U|6 ShoulderPart1_R -|"
      "7 ShoulderPart2_R -|8 Elbow_R E|9 ElbowPart1_R -|10 ElbowPart2_R -|11 Wrist_R W|4 Neck_M N|5 Head_M -|"
      "4 Scapula_L -|5 Shoulder_L u|6 ShoulderPart1_L -|7 ShoulderPart2_L -|8 Elbow_L e|9 ElbowPart1_L -|"
      "10 ElbowPart2_L -|11 Wrist_L w|1 Hip_L t|2 HipPart1_L -|3 HipPart2_L -|4 Knee_L k|5 KneePart1_L -|"
      "6 KneePart2_L -|7 Ankle_L f|8 Toes_L -" },
    { "SMPL-X", "0 pelvis P|1 left_hip t|2 left_knee k|3 left_ankle f|4 left_foot -|1 right_hip T|2 right_knee K|"
                "3 right_ankle F|1 spine1 S|2 spine2 -|3 spine3 C|4 neck N|5 head -|4 left_collar -|5 left_shoulder u|"
                "6 left_elbow e|7 left_wrist w|8 left_index1 -|4 right_collar -|5 right_shoulder U|6 right_elbow E|"
                "7 right_wrist W" },
    { "OptiTrack", "0 Hip P|1 Ab S|2 Chest C|3 Neck N|4 Head -|3 LShoulder -|4 LUArm u|"
                   "5 LFArm e|6 LHand w|3 RShoulder -|4 RUArm U|5 RFArm E|6 RHand W|"
                   "1 LThigh t|2 LShin k|3 LFoot f|4 LToe -|1 RThigh T|2 RShin K|3 RFoot F" },
    { "Xsens", "0 Pelvis P|1 L5 S|2 L3 -|3 T12 -|4 T8 C|5 Neck N|6 Head -|5 RightShoulder -|6 RightUpperArm U|"
               "7 RightForeArm E|8 RightHand W|5 LeftShoulder -|6 LeftUpperArm u|7 LeftForeArm e|8 LeftHand w|"
               "1 RightUpperLeg T|2 RightLowerLeg K|3 RightFoot F|4 RightToe -|1 LeftUpperLeg t|2 LeftLowerLeg k|"
               "3 LeftFoot f" },
    { "Roblox", "0 HumanoidRootPart -|1 LowerTorso P|2 UpperTorso C|3 Head N|3 LeftUpperArm u|4 LeftLowerArm e|"
                "5 LeftHand w|3 RightUpperArm U|4 RightLowerArm E|5 RightHand W|2 LeftUpperLeg t|3 LeftLowerLeg k|"
                "4 LeftFoot f|2 RightUpperLeg T|3 RightLowerLeg K|4 RightFoot F" },
    { "Khronos's CesiumMan",
      "0 Skeleton_torso_joint_1 P|1 Skeleton_torso_joint_2 S|2 torso_joint_3 C|3 Skeleton_neck_joint_1 N|"
      "4 Skeleton_neck_joint_2 -|3 Skeleton_arm_joint_L__4_ u|4 Skeleton_arm_joint_L__3_ e|"
      "5 Skeleton_arm_joint_L__2_ w|3 Skeleton_arm_joint_R U|4 Skeleton_arm_joint_R__2_ E|"
      "5 Skeleton_arm_joint_R__3_ W|1 leg_joint_L_1 t|2 leg_joint_L_2 k|3 leg_joint_L_3 f|4 leg_joint_L_5 -|"
      "1 leg_joint_R_1 T|2 leg_joint_R_2 K|3 leg_joint_R_3 F|4 leg_joint_R_5 -" },
    { "MikuMikuDance in English",
      "0 center P|1 upper body S|2 upper body2 C|3 neck N|4 head -|3 shoulder_L -|4 arm_L u|5 elbow_L e|6 wrist_L w|"
      "3 shoulder_R -|4 arm_R U|5 elbow_R E|6 wrist_R W|1 lower body -|2 leg_L t|3 knee_L k|4 ankle_L f|5 toe_L -|"
      "2 leg_R T|3 knee_R K|4 ankle_R F|0 leg IK_L -|1 toe IK_L -" },
    { "MikuMikuDance, with a digit of full width",
      "0 センター P|1 上半身 S|2 上半身２ C|3 首 N|4 頭 -|3 左肩 -|4 左腕 u|5 左ひじ e|6 左手首 w|3 右肩 -|4 右腕 U|"
      "5 右ひじ E|6 右手首 W|1 下半身 -|2 左足 t|3 左ひざ k|4 左足首 f|2 右足 T|3 右ひざ K|4 右足首 F|0 左足ＩＫ -" },
    { "VRoid", "0 Root -|1 J_Bip_C_Hips P|2 J_Bip_C_Spine S|3 J_Bip_C_Chest -|4 J_Bip_C_UpperChest C|5 J_Bip_C_Neck N|"
               "6 J_Bip_C_Head -|5 J_Bip_L_Shoulder -|6 J_Bip_L_UpperArm u|7 J_Bip_L_LowerArm e|8 J_Bip_L_Hand w|"
               "5 J_Bip_R_Shoulder -|6 J_Bip_R_UpperArm U|7 J_Bip_R_LowerArm E|8 J_Bip_R_Hand W|2 J_Bip_L_UpperLeg t|"
               "3 J_Bip_L_LowerLeg k|4 J_Bip_L_Foot f|5 J_Bip_L_ToeBase -|2 J_Bip_R_UpperLeg T|"
               "3 J_Bip_R_LowerLeg K|4 J_Bip_R_Foot F" },
    { "a figure that wears and carries things",
      "0 Hips P|1 handbag -|1 Hand_Bag -|1 LegArmor -|1 handle_l -|1 legging -|1 LeftUpLeg t|2 LeftLeg k|3 LeftFoot f|"
      "4 toenail -|1 RightUpLeg T|2 RightLeg K|3 RightFoot F|1 Spine S|2 Spine1 C|3 armor -|3 necklace -|3 headphones -|"
      "3 alarm -|3 Neck N|4 Head -|5 earring_l -|3 LeftShoulder -|4 LeftArm u|5 LeftForeArm e|6 LeftHand w|"
      "3 RightShoulder -|4 shoulderpad_r -|4 RightArm U|5 RightForeArm E|6 RightHand W" },
    { "German",
      "0 Becken P|1 OberschenkelLinks t|2 UnterschenkelLinks k|3 FussLinks f|1 OberschenkelRechts T|"
      "2 UnterschenkelRechts K|3 FussRechts F|1 Wirbelsaeule S|2 Brust C|3 Hals N|4 Kopf -|3 SchulterLinks -|"
      "4 OberarmLinks u|5 UnterarmLinks e|6 HandLinks w|3 Schulter_Rechts -|4 Oberarm_Rechts U|5 Unterarm_Rechts E|"
      "6 Hand_Rechts W" },
    { "small letters alone",
      "0 hips P|1 leftupperleg t|2 leftlowerleg k|3 leftfoot f|1 rightupperleg T|2 rightlowerleg K|3 rightfoot F|"
      "1 spine S|2 chest C|3 neck N|4 head -|3 leftshoulder -|4 leftupperarm u|5 leftforearm e|6 lefthand w|"
      "3 rightshoulder -|4 rightupperarm U|5 rightforearm E|6 righthand W" },
};

/* A pack of a skeleton alone, whose left limbs begin on the left. */
typedef struct named {
    noh_pack pack;
    noh_pack_chunk chunk;
    struct {
        noh_skeleton_header header;
        uint32_t names[JOINTS_MAX];
        uint16_t parents[JOINTS_MAX];
    } bytes;
    noh_transform bind[JOINTS_MAX];
    char strings[4096], marks[JOINTS_MAX];
    noh_ragdoll_source source;
} named;

static void add_joint(named *n, uint32_t depth, const char *name, size_t length, char mark)
{
    static uint16_t last[16];
    const uint32_t j = n->source.joints.joint_count++;
    assert_true(j < JOINTS_MAX && depth < 16 && n->pack.string_bytes + length < sizeof n->strings);
    n->bytes.names[j] = n->pack.string_bytes;
    memcpy(n->strings + n->pack.string_bytes, name, length);
    n->pack.string_bytes += (uint32_t)length + 1u;
    n->bytes.parents[j] = depth ? last[depth - 1] : NOH_JOINT_ROOT;
    n->marks[j] = mark;
    n->bind[j].rotation[3] = 1.0f;
    for (int i = 0; i < 3; i++) n->bind[j].scale[i] = 1.0f;
    n->bind[j].translation[0] = strchr("ut", mark) ? 1.0f : strchr("UT", mark) ? -1.0f : 0.0f;
    last[depth] = (uint16_t)j;
}

static named *named_of(const char *joints)
{
    named *n = test_zeros(sizeof *n);
    for (const char *at = joints; *at;) {
        const size_t length = strcspn(at, "|");
        char *name;
        const uint32_t depth = (uint32_t)strtoul(at, &name, 10);
        add_joint(n, depth, name + 1, (size_t)(at + length - name) - 3u, at[length - 1]);
        at += length + (at[length] != '\0');
    }
    n->bytes.header.joint_count = n->source.joints.joint_count;
    n->bytes.header.names_offset = (uint32_t)((uint8_t *)n->bytes.names - (uint8_t *)&n->bytes);
    n->bytes.header.parents_offset = (uint32_t)((uint8_t *)n->bytes.parents - (uint8_t *)&n->bytes);
    n->pack.bytes = (const uint8_t *)&n->bytes;
    n->pack.chunks = &n->chunk;
    n->pack.chunk_count = n->pack.runs[NOH_CHUNK_SKELETON].count = 1;
    n->pack.strings = n->strings;
    n->source.pack = &n->pack;
    n->source.joints.parents = n->bytes.parents;
    n->source.joints.bind_pose = n->bind;
    return n;
}

static const char *name_of(const named *n, uint32_t joint)
{
    return joint < n->source.joints.joint_count ? n->strings + n->bytes.names[joint] : "none";
}

/* What tells a row's part, as a mark without its side: * for what is neither a forearm nor of a leg. */
static char mark_of(const noh_ragdoll_row *row)
{
    if (row->hinge) return row->toward == NOH_RAGDOLL_BACKWARD ? 'k' : 'e';
    return row->toward == NOH_RAGDOLL_UPWARD ? 'f' : '*';
}

static uint32_t check_rows(const char *program, const named *n)
{
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count = 0, wrong = 0, row = 0;
    noh_error error = { 0 };
    if (noh_ragdoll_find_rows(&n->source, rows, &count, &error)) print_message("%s: %s\n", program, error.what);
    for (uint32_t j = 0; j < n->source.joints.joint_count; j++) {
        const int found = row < count && rows[row].joint == j;
        const char mark = n->marks[j], small = (char)(mark | 32);
        const char kind = mark != '-' && strchr("kef", small) ? small : '*';
        if (found != (mark != '-') || (found && mark_of(&rows[row]) != kind)) {
            print_message("%s: %s: %c, and should be %c\n", program, name_of(n, j), found ? mark_of(&rows[row]) : '-',
                          mark);
            wrong++;
        }
        row += (uint32_t)found;
    }
    return wrong;
}

static uint32_t check_bones(const char *program, const named *n)
{
    static const struct {
        char mark;
        uint32_t bone;
    } limbs[] = { { 'u', NOH_BONE_UPPER_ARM }, { 'e', NOH_BONE_UPPER_ARM + 1u }, { 'w', NOH_BONE_UPPER_ARM + 2u },
                  { 't', NOH_BONE_UPPER_LEG }, { 'k', NOH_BONE_UPPER_LEG + 1u }, { 'f', NOH_BONE_UPPER_LEG + 2u } };
    noh_retarget_rig bones;
    uint32_t wrong = 0;
    if (noh_retarget_rig_make(&n->source, &bones, NULL)) return 1;
    for (uint32_t i = 0; i < 2u * TEST_COUNT(limbs); i++) {
        const char mark = (char)(limbs[i / 2u].mark ^ (i & 1u ? 32 : 0));
        const uint32_t bone = limbs[i / 2u].bone + (i & 1u ? NOH_BONE_RIGHT : 0u), joint = bones.bones[bone];
        if (joint < n->source.joints.joint_count && n->marks[joint] == mark) continue;
        print_message("%s: bone %c is %s\n", program, mark, name_of(n, joint));
        wrong++;
    }
    return wrong;
}

static void rigs_of_many_programs(void **state)
{
    uint32_t wrong = 0;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(rigs); i++) {
        named *n = named_of(rigs[i].joints);
        wrong += check_rows(rigs[i].program, n) + check_bones(rigs[i].program, n);
        free(n);
    }
    assert_int_equal(wrong, 0);
}

/* Hands that hang from a joint each, or on one side alone: the chest is no bone of an arm. */
static void a_chest_is_no_arm(void **state)
{
    static const char *const hands[] = { "2 socket1 -|3 LeftHand -|2 socket2 -|3 RightHand -", "2 LeftHand -",
                                         "2 RightHand -", "2 LeftHand -|2 RightHand -" };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(hands); i++) {
        char joints[256];
        noh_retarget_rig made;
        snprintf(joints, sizeof joints, "0 Hips -|1 Chest -|%s|1 LeftUpLeg -|1 RightUpLeg -", hands[i]);
        named *n = named_of(joints);
        assert_int_equal(noh_retarget_rig_make(&n->source, &made, NULL), NOH_OK);
        for (uint32_t side = 0; side <= NOH_BONE_RIGHT; side += NOH_BONE_RIGHT) {
            assert_int_equal(made.bones[NOH_BONE_UPPER_ARM + side], NOH_JOINT_ROOT);
            assert_int_not_equal(made.bones[NOH_BONE_UPPER_ARM + 1u + side], 1);
        }
        free(n);
    }
}

/* A chain as long as a skeleton may be, each of whose joints may be a limb: the time is not a power of its length. */
static void long_chains_take_no_time(void **state)
{
    static const char *const names[] = { "hip", "shoulder", "arm", "leg", "knee", "elbow", "hand", "foot" };
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    (void)state;
    for (uint32_t last = 1; last <= TEST_COUNT(names); last++) {
        named *n = named_of("0 root -");
        for (uint32_t i = 0; i < TEST_COUNT(names); i++) {
            add_joint(n, 1, names[i], strlen(names[i]), '-');
        }
        for (uint32_t j = 1; j < JOINTS_MAX; j++) {
            n->bytes.names[j] = n->bytes.names[1u + j % last];
            n->bytes.parents[j] = (uint16_t)(j - 1u);
        }
        n->bytes.header.joint_count = n->source.joints.joint_count = JOINTS_MAX;
        assert_int_equal(noh_ragdoll_find_rows(&n->source, rows, &count, NULL), NOH_ERR_NOT_FOUND);
        free(n);
    }
}

static void words_are_whole(void **state)
{
    static const struct {
        const char *name, *word;
        int has;
    } rows[] = {
        { "upper_arm.L", "upperarm", 1 },
        { "upper_arm.L", "arm", 1 },
        { "mixamorig:LeftHand", "hand", 1 },
        { "LEFTHAND", "hand", 1 },
        { "lHand01", "hand", 1 },
        { "rhand", "hand", 1 },
        { "handr", "hand", 1 },
        { "hands", "hand", 1 },
        { "frontleg_l", "leg", 1 },
        { "hindlegl", "leg", 1 },
        { "backleg.R", "leg", 1 },
        { "headbone", "head", 1 },
        { "kneejoint_r", "knee", 1 },
        { "handbag", "hand", 0 },
        { "HANDBAG", "hand", 0 },
        { "handle", "hand", 0 },
        { "armor", "arm", 0 },
        { "alarm", "arm", 0 },
        { "Armature", "arm", 0 },
        { "legging", "leg", 0 },
        { "headphones", "head", 0 },
        { "forehead", "head", 1 }, /* as a foreleg is a leg: callers look for it first */
        { "necklace", "neck", 0 },
        { "earring", "ear", 0 },
        { "LeftEar", "ear", 1 },
        { "rear", "ear", 1 }, /* as rarm is an arm */
        { "eyebrow", "eye", 0 },
        { "J_Adj_L_FaceEye", "eye", 1 },
        { "toenail", "toe", 0 },
        { "shoulderpad", "shoulder", 0 },
        { "lowerback", "back", 1 },
        { "chestUpper", "chest", 1 },
        { "brown_shoe", "brow", 0 },
        { "Brows", "brow", 1 },
        { "armchair", "hair", 0 },
        { "HairBack", "hair", 1 },
        { "", "hand", 0 },
        { "han", "hand", 0 },
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(rows); i++) {
        if (noh_name_has(rows[i].name, rows[i].word) != rows[i].has) fail_msg("%s: %s", rows[i].name, rows[i].word);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_whole),
        cmocka_unit_test(rigs_of_many_programs),
        cmocka_unit_test(a_chest_is_no_arm),
        cmocka_unit_test(long_chains_take_no_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
