/* names_table.c: what exporters call targets, joints and materials. Of lines that have a name, the first counts. */
#include "names_table.h"

#include <stddef.h>

/* clang-format off */
const char *const names_table[] = {
    /* Targets: channels of a recipe (noh help FORMATS) and ARKit's 52. Other names: Oculus (viseme_*), VRChat (v_*), VRoid
     * (Fcl_*), Character Creator (Eye_Blink_L, V_*, B_M_P), Daz Genesis 8 (eCTRL*) and 9 (facs_*), MikuMikuDance. */
    "target sil viseme_sil v_sil",
    "target PP viseme_PP v_pp V_Explosive B_M_P vM",
    "target FF viseme_FF v_ff V_Dental_Lip F_V vF",
    "target TH viseme_TH v_th vTH",
    "target DD viseme_DD v_dd T_L_D_N vT",
    "target kk viseme_kk v_kk K_G_H_NG vK",
    "target CH viseme_CH v_ch V_Affricate Ch_J vSH",
    "target SS viseme_SS v_ss S_Z vS",
    "target nn viseme_nn v_nn vL",
    "target RR viseme_RR v_rr vER",
    "target aa viseme_aa v_aa V_Open Ah Fcl_MTH_A vAA あ",
    "target E viseme_E v_e AE Fcl_MTH_E vEH え",
    "target ih viseme_I viseme_ih v_ih Fcl_MTH_I vIH い",
    "target oh viseme_O viseme_oh v_oh Oh Fcl_MTH_O vOW お",
    "target ou viseme_U viseme_ou v_ou V_Tight_O W_OO Fcl_MTH_U vUW う",
    "target joy-upper Fcl_ALL_Joy",
    "target anger-upper Fcl_ALL_Angry",
    "target sadness-upper Fcl_ALL_Sorrow",
    "target surprise-upper Fcl_ALL_Surprised",
    "target eyeBlink* Eye_Blink_* Fcl_EYE_Close_* EyesClosed*",
    "target eyeLookDown* Eye_*_Look_Down EyesDown*",
    "target eyeLookIn* Eye_*_Look_In",
    "target eyeLookOut* Eye_*_Look_Out",
    "target eyeLookUp* Eye_*_Look_Up EyesUp*",
    "target eyeSquint* EyesSquint*",
    "target eyeWide*",
    "target jawForward",
    "target jawLeft",
    "target jawRight",
    "target jawOpen Mouth_Open MouthOpen",
    "target mouthClose Mouth_Close MouthCloseFull",
    "target mouthFunnel Mouth_Funnel_Up_* Mouth_Funnel_Down_*",
    "target mouthPucker Mouth_Pucker_Up_* Mouth_Pucker_Down_*",
    "target mouthLeft",
    "target mouthRight",
    "target mouthSmile* MouthSmileSimple* Mouth_Corner_Up_*",
    "target mouthFrown*",
    "target mouthDimple*",
    "target mouthStretch* MouthWiden*",
    "target mouthRollLower Mouth_Roll_In_Lower_*",
    "target mouthRollUpper Mouth_Roll_In_Upper_*",
    "target mouthShrugLower",
    "target mouthShrugUpper",
    "target mouthPress*",
    "target mouthLowerDown* Mouth_Down_Lower_*",
    "target mouthUpperUp* Mouth_Up_Upper_*",
    "target browDown* Brow_Drop_* BrowsDown*",
    "target browInnerUp BrowsInnerUp browInnerUp_* Brow_Raise_Inner_*",
    "target browOuterUp* Brow_Raise_Outer_* BrowOuterUp*",
    "target cheekPuff cheekPuff_*",
    "target cheekSquint* Cheek_Raise_*",
    "target noseSneer* NoseWrinkle*",
    "target tongueOut",
    /* Bones of a person, by VRM's names for them. Other names: Unity (HumanBodyBones), Mixamo, Unreal and MetaHuman,
     * Character Creator, Daz Genesis, 3ds Max's biped, MPFB and MakeHuman, Rigify. */
    "joint hips pelvis Hip CC_Base_Hip",
    "joint spine spine_01 abdomenLower abdomen LowerBack CC_Base_Waist",
    "joint chest spine_02 Spine1 chestLower CC_Base_Spine01",
    "joint upperChest spine_03 Spine2 chestUpper CC_Base_Spine02",
    "joint neck neck_01 Neck1 neckLower CC_Base_NeckTwist01",
    "joint head",
    "joint *Eye FACIAL_*_Eye Face_*_Eye eye_*_socket",
    "joint jaw lowerJaw JawRoot",
    "joint *Shoulder clavicle_* Collar_* shoulder01_*",
    "joint *UpperArm *Arm *Shldr *ShldrBend upperarm01_* Biceps_*",
    "joint *LowerArm *ForeArm *ForearmBend lowerarm01_* *Elbow",
    "joint *Hand wrist_*",
    "joint *UpperLeg *UpLeg thigh_* *ThighBend upperleg01_*",
    "joint *LowerLeg *Leg calf_* shin_* lowerleg01_* *Knee",
    "joint *Foot ankle_*",
    "joint *Toes *ToeBase ball_* *Toe toe_* *Toe0",
    "joint *ThumbMetacarpal *HandThumb1 thumb_01_* *Thumb1 *ThumbProximal",
    "joint *ThumbProximal *HandThumb2 thumb_02_* *Thumb2 *ThumbIntermediate",
    "joint *ThumbDistal *HandThumb3 thumb_03_* *Thumb3",
    "joint *IndexProximal *HandIndex1 index_01_* *Index1",
    "joint *IndexIntermediate *HandIndex2 index_02_* *Index2",
    "joint *IndexDistal *HandIndex3 index_03_* *Index3",
    "joint *MiddleProximal *HandMiddle1 middle_01_* *Middle1 *Mid1",
    "joint *MiddleIntermediate *HandMiddle2 middle_02_* *Middle2 *Mid2",
    "joint *MiddleDistal *HandMiddle3 middle_03_* *Middle3 *Mid3",
    "joint *RingProximal *HandRing1 ring_01_* *Ring1",
    "joint *RingIntermediate *HandRing2 ring_02_* *Ring2",
    "joint *RingDistal *HandRing3 ring_03_* *Ring3",
    "joint *LittleProximal *HandPinky1 pinky_01_* *Pinky1",
    "joint *LittleIntermediate *HandPinky2 pinky_02_* *Pinky2",
    "joint *LittleDistal *HandPinky3 pinky_03_* *Pinky3",
    /* What stands in front of names, or behind them. */
    "strip mixamorig J_Bip_C J_Bip J_Adj_C J_Adj J_Sec CC_Base Bip001 Bip01 DEF ORG ValveBiped_Bip01 Armature",
    "strip facs_bs facs_jnt facs_cbs facs_ctrl facs body_bs head_bs eCTRL head_eCTRL div2",
    "strip Genesis8Female Genesis8Male Genesis9",
    "strip head_facs_bs blendShape1 blendShape",
    /* Materials by the words of their names, in small letters; *PART is found anywhere, for languages that put no spaces
     * between words. beside-eye: no eye, though a word says so: lashes, lids, occlusion shells, tear lines, glasses. */
    "material skin skin haut peau piel pelle pele huid skóra skora кожа *肌 *皮膚 *皮肤 *피부",
    "material eye eye eyes eyeball eyeballs iris irises pupil pupils sclera scleras cornea corneas auge "
    "augen augapfel œil oeil yeux ojo ojos olho olhos occhio occhi oog ogen oko oczy глаз глаза *目 *瞳 *眼 "
    "*눈",
    "material teeth tooth teeth gum gums tongue zahn zähne zaehne zunge zahnfleisch dent dents gencive "
    "gencives langue diente dientes encía encia lengua dente dentes gengiva língua lingua denti lingue "
    "tand tanden tong zęby zeby język jezyk зуб зубы язык дёсны десны *歯 *舌 *牙 *齿 *이빨 *혀",
    "material toon toon mtoon celshade",
    "material beside-eye line highlight lash lashes eyelash eyelashes brow brows eyebrow eyebrows lid "
    "lids eyelid eyelids liner eyeliner eyeline shadow eyeshadow occlusion eyeocclusion shell moisture "
    "eyemoisture tear tears tearline lacrimal glass glasses eyeglasses patch mask socket sockets "
    "eyesocket wimper wimpern braue brauen lider cil cils sourcil sourcils pestaña pestañas ceja cejas "
    "ciglia sopracciglia ресницы брови *睫 *眉 *影 *眼鏡 *眼镜 *안경 *눈썹",
    NULL
};
/* clang-format on */
