// view_pad_panel.cpp: a blend space to drag a point in.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#include <cstdio>

namespace
{

const ImU32 line_color = IM_COL32(90, 90, 94, 255), clip_color = IM_COL32(190, 170, 130, 255),
            point_color = IM_COL32(237, 178, 92, 255);

// The square that the pad is drawn in: a place of -1..1, y up, to the window and back.
struct square {
    ImVec2 corner;
    float side;
    ImVec2 window(const float at[2]) const
    {
        return ImVec2(corner.x + (0.5f + 0.5f * at[0]) * side, corner.y + (0.5f - 0.5f * at[1]) * side);
    }
    void place(const ImVec2 &mouse, float at[2]) const
    {
        at[0] = 2.0f * (mouse.x - corner.x) / side - 1.0f;
        at[1] = 1.0f - 2.0f * (mouse.y - corner.y) / side;
    }
};

// The clip under the mouse, or `count`.
uint32_t clip_under(const view_pad *pad, const square &box, const ImVec2 &mouse)
{
    for (uint32_t i = 0; i < pad->count; i++) {
        const ImVec2 at = box.window(pad->points[i]);
        const float x = mouse.x - at.x, y = mouse.y - at.y;
        if (x * x + y * y < 49.0f) {
            return i;
        }
    }
    return pad->count;
}

// Pressed on a clip, the mouse moves that; else the point.
void drag(view_app *a, const square &box)
{
    static uint32_t held;
    view_pad *pad = &a->pad;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    float at[2];
    if (ImGui::IsItemActivated()) {
        held = clip_under(pad, box, mouse);
    }
    if (!ImGui::IsItemActive()) {
        return;
    }
    box.place(mouse, at);
    if (held < pad->count) {
        view_pad_move_clip(pad, a->model, held, at[0], at[1]);
    } else {
        view_pad_move(pad, a->model, at[0], at[1]);
    }
}

void draw(const view_app *a, const square &box)
{
    const view_pad *pad = &a->pad;
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRect(box.corner, ImVec2(box.corner.x + box.side, box.corner.y + box.side), line_color);
    for (uint32_t t = 0; t < pad->triangle_count; t++) {
        const uint8_t *c = pad->triangles[t];
        list->AddTriangle(box.window(pad->points[c[0]]), box.window(pad->points[c[1]]), box.window(pad->points[c[2]]),
                          line_color);
    }
    for (uint32_t i = 0; i < pad->count; i++) {
        const ImVec2 at = box.window(pad->points[i]);
        const char *name = a->model->clips[pad->clips[i]].name;
        const ImVec2 size = ImGui::CalcTextSize(name);
        const float right = box.corner.x + box.side - size.x - 2.0f;
        list->AddCircleFilled(at, 3.0f + 5.0f * pad->weights[i], clip_color);
        list->AddText(ImVec2(at.x + 10.0f < right ? at.x + 10.0f : right, at.y + 4.0f), clip_color, name);
    }
    list->AddCircle(box.window(pad->at), 6.0f, point_color, 0, 2.0f);
}

void square_of(view_app *a)
{
    const square box = { ImGui::GetCursorScreenPos(), ImGui::GetContentRegionAvail().x * 0.7f };
    ImGui::InvisibleButton("pad", ImVec2(box.side, box.side));
    ui::note("pad");
    drag(a, box);
    draw(a, box);
    ImGui::SameLine();
    ImGui::BeginGroup();
    for (uint32_t i = 0; i < a->pad.count; i++) {
        ImGui::Text("%.2f %s", static_cast<double>(a->pad.weights[i]), a->model->clips[a->pad.clips[i]].name);
    }
    if (a->pad.plays) {
        ImGui::TextDisabled(a->pad.synced ? "in sync" : "not in sync");
    }
    ImGui::EndGroup();
}

// Clips, and blend spaces of the pack's graphs.
void choose(view_app *a)
{
    char name[256];
    if (!ui::begin_combo("clips", a->pad.count ? "..." : "choose some")) {
        return;
    }
    const ui::in within("clips");
    for (uint32_t i = 0; i < a->model->clip_count; i++) {
        if (ui::selectable(a->model->clips[i].name, view_pad_has(&a->pad, i) != 0,
                           ImGuiSelectableFlags_DontClosePopups)) {
            view_pad_choose(a, i);
        }
    }
    for (uint32_t n = 0; view_pad_space(a->model, n, name, sizeof name); n++) {
        if (ui::selectable(name, false)) {
            view_pad_take(&a->pad, a->model, n);
        }
    }
    ImGui::EndCombo();
}

} // namespace

void pad_section(view_app *a)
{
    if (a->model->clip_count < 2 || !ui::section("Blend space", false)) {
        return;
    }
    const ui::in within("blend");
    {
        const ui::labelled width;
        choose(a);
    }
    if (!a->pad.count) {
        ImGui::TextDisabled("three or more; drag the point, or the clips");
        return;
    }
    square_of(a);
    if (ui::button(a->pad.plays ? "stop##pad" : "play##pad", 60.0f)) {
        view_pad_switch(a);
    }
}
