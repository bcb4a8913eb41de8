// view_draw_panel.cpp: what is drawn of the figure and over it, by which path, and the second figure.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

namespace
{

// ---- the surface ----

const char *const surfaces[] = { "lit",       "position", "normal", "tangent", "level",      "light",
                                 "occlusion", "wrinkle",  "joints", "weights", "bones alone" };
const int joints_at = 8, bones_at = 10;

void surface_combo(view_app *a)
{
    const int has_joints = a->model->file.pack.runs[NOH_CHUNK_SKELETON].count ? 3 : 0;
    int at = a->desc.show_bones ? bones_at
             : a->over.skin     ? joints_at + a->over.skin - 1
                                : static_cast<int>(a->desc.view);
    if (!ui::choose("surface", &at, surfaces, joints_at + has_joints)) {
        return;
    }
    a->over.skin = at == bones_at || at < joints_at ? VIEW_SKIN_OFF : static_cast<view_skin>(at - joints_at + 1);
    a->request.desc.show_bones = at == bones_at;
    a->request.desc.view = at < joints_at ? static_cast<noh_debug_view>(at) : NOH_VIEW_LIT;
    a->request.reload |= a->request.desc.show_bones != a->desc.show_bones || a->request.desc.view != a->desc.view;
}

// Whose weights are shown.
void joint_combo(view_app *a)
{
    noh_stage *stage = a->model->figure->stage;
    const char *shown = noh_stage_name(stage, 0, NOH_NAME_JOINT, a->over.joint);
    if (a->over.skin != VIEW_SKIN_WEIGHTS || !ui::begin_combo("of joint", shown ? shown : "")) {
        return;
    }
    const ui::in within("of joint");
    for (uint32_t i = 0; const char *name = noh_stage_name(stage, 0, NOH_NAME_JOINT, i); i++) {
        ImGui::PushID(static_cast<int>(i));
        if (ui::selectable(name, i == a->over.joint)) {
            a->over.joint = i;
        }
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

// What the colours of weights mean.
void heat_scale()
{
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight();
    for (int i = 0; i < 32; i++) {
        float rgb[3];
        overlay_heat((static_cast<float>(i) + 0.5f) / 32.0f, rgb);
        const ImU32 color = imgui_color(rgb);
        ImGui::GetWindowDrawList()->AddRectFilled(
            ImVec2(at.x + width * static_cast<float>(i) / 32.0f, at.y),
            ImVec2(at.x + width * static_cast<float>(i + 1) / 32.0f, at.y + height), color);
    }
    ImGui::GetWindowDrawList()->AddText(ImVec2(at.x + 4.0f, at.y), IM_COL32_WHITE, "0");
    ImGui::GetWindowDrawList()->AddText(ImVec2(at.x + width - 11.0f, at.y), IM_COL32_WHITE, "1");
    ImGui::Dummy(ImVec2(width, height));
}

// ---- how ----

void path_combo(view_app *a)
{
    const char *names[NOH_MORPH_PATH_COUNT];
    for (int i = 0; i < NOH_MORPH_PATH_COUNT; i++) {
        names[i] = noh_morph_path_name(static_cast<noh_morph_path>(i));
    }
    int at = static_cast<int>(a->desc.morph_path);
    if (ui::choose("path", &at, names, NOH_MORPH_PATH_COUNT)) {
        a->request.desc.morph_path = static_cast<noh_morph_path>(at);
        a->request.reload = 1;
    }
}

void accumulate_combo(view_app *a)
{
    const char *names[3];
    for (int i = 0; i < 3; i++) {
        names[i] = noh_accumulate_name(static_cast<noh_accumulate>(i));
    }
    int at = static_cast<int>(a->desc.accumulate);
    if (ui::choose("accumulators", &at, names, 3)) {
        a->request.desc.accumulate = static_cast<noh_accumulate>(at);
        a->request.reload = 1;
    }
}

// Which models of wrinkles show, and how much of them.
void wrinkle_controls(view_app *a)
{
    static const char *const models[] = { "as built", "by area", "by region", "by channel" };
    static const int bits[] = { 0, NOH_WRINKLE_BY_AREA, NOH_WRINKLE_BY_REGION, NOH_WRINKLE_BY_CHANNEL };
    int model = 0;
    for (int i = 1; i < 4; i++) {
        model = a->lod.wrinkle_models == bits[i] ? i : model;
    }
    if (ui::choose("wrinkles", &model, models, 4)) {
        a->lod.wrinkle_models = bits[model];
    }
    ui::slider("##wrinkled", &a->lod.wrinkles, 0.0f, 1.0f, "wrinkled %.2f");
}

// ---- a second one ----

void level_combo(view_app *a)
{
    static const char *const names[] = { "full",    "level 1", "level 2", "level 3",
                                         "level 4", "level 5", "level 6", "level 7" };
    int at = static_cast<int>(a->compare.how.level);
    const uint32_t count = a->model->costs.count < 8 ? a->model->costs.count : 8;
    if (ui::choose("with level", &at, names, static_cast<int>(count))) {
        a->compare.how.level = static_cast<uint32_t>(at);
    }
}

void other_path_combo(view_app *a)
{
    const char *names[NOH_MORPH_PATH_COUNT];
    for (int i = 0; i < NOH_MORPH_PATH_COUNT; i++) {
        names[i] = noh_morph_path_name(static_cast<noh_morph_path>(i));
    }
    int at = static_cast<int>(a->compare.how.path);
    if (ui::choose("with path", &at, names, NOH_MORPH_PATH_COUNT)) {
        a->compare.how.path = static_cast<noh_morph_path>(at);
    }
}

} // namespace

void drawing_section(view_app *a)
{
    if (!ui::section("Drawing", true)) {
        return;
    }
    {
        const ui::labelled width;
        surface_combo(a);
        joint_combo(a);
        if (a->over.skin == VIEW_SKIN_WEIGHTS) {
            heat_scale();
        }
    }
    ui::checkbox("wireframe", &a->over.wireframe);
    ImGui::SameLine();
    ui::checkbox("normals", &a->over.normals);
    if (a->model->file.pack.runs[NOH_CHUNK_SKELETON].count) {
        ImGui::SameLine();
        ui::checkbox("bones", &a->over.bones);
        ui::hint("over the mesh; B");
    }
    const ui::labelled width;
    path_combo(a);
    accumulate_combo(a);
    if (a->model->file.pack.runs[NOH_CHUNK_WRINKLES].count) {
        wrinkle_controls(a);
    }
    if (a->model->is_morphed) {
        const noh_gl_morph_plan *plan = &a->model->morph_plan;
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextWrapped("%s-%s: %s", noh_morph_path_name(plan->path), noh_accumulate_name(plan->accumulate),
                           plan->reason);
        ImGui::PopStyleColor();
    }
}

void compare_section(view_app *a)
{
    static const char *const withs[] = { "off", "another level", "another path" };
    view_compare *c = &a->compare;
    if (!ui::section("Compare", false)) {
        return;
    }
    const ui::labelled width;
    int with = static_cast<int>(c->how.with);
    if (ui::choose("side by side", &with, withs, 3)) {
        c->how.with = static_cast<view_compare_with>(with);
        if (c->how.with == VIEW_COMPARE_LEVEL && a->model->costs.count > 1 && !c->how.level) {
            c->how.level = a->model->costs.count - 1;
        }
    }
    if (c->how.with == VIEW_COMPARE_LEVEL) {
        level_combo(a);
    } else if (c->how.with == VIEW_COMPARE_PATH) {
        other_path_combo(a);
    }
    if (c->how.with == VIEW_COMPARE_OFF) {
        return;
    }
    ui::slider("##difference", &c->gain, 1.0f, 64.0f, "difference times %.0f", ImGuiSliderFlags_Logarithmic);
    const double pixels = static_cast<double>(a->model->canvas.width) * a->model->canvas.height;
    ImGui::Text("%.2f %% of it differs, by at most %u of 255", 100.0 * c->differing / pixels, c->most);
}
