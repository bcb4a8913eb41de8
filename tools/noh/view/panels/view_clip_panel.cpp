// view_clip_panel.cpp: the clips of a pack, what plays of them, how fast.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

namespace
{

void clip_row(view_app *a, uint32_t clip)
{
    const view_clip &c = a->model->clips[clip];
    const ui::in row(c.name);
    ImGui::PushID(static_cast<int>(clip));
    if (ui::small_button("play")) {
        view_play(a, clip, 0);
    }
    ImGui::SameLine();
    if (ui::small_button("add")) {
        view_play(a, clip, 1);
    }
    ui::hint("play it in addition to the other clips");
    ImGui::SameLine();
    const float room = ImGui::GetWindowContentRegionMax().x - 68.0f - ImGui::GetCursorPosX();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushClipRect(at, ImVec2(at.x + room, at.y + ImGui::GetTextLineHeight()), true);
    ImGui::TextUnformatted(c.name);
    ImGui::PopClipRect();
    if (ImGui::CalcTextSize(c.name).x > room) {
        ui::hint(c.name);
    }
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 64.0f);
    ImGui::TextDisabled("%7.2f s", c.seconds);
    ImGui::PopID();
}

} // namespace

void clips_section(view_app *a)
{
    view_model *m = a->model;
    if (!ui::section("Clips", true)) {
        return;
    }
    if (!m->clip_count) {
        ImGui::TextDisabled("none in this file");
        return;
    }
    if (ui::button(a->playing ? "pause" : "play", 60.0f)) {
        view_toggle_play(a);
    }
    ImGui::SameLine();
    if (ui::button("stop all")) {
        view_stop_all(m);
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    ui::slider("##speed", &a->speed, 0.0f, 2.0f, "speed %.2f");
    const float rows = m->clip_count < 8 ? static_cast<float>(m->clip_count) : 8.0f;
    ImGui::BeginChild("clips", ImVec2(0.0f, rows * ImGui::GetTextLineHeightWithSpacing()));
    for (uint32_t i = 0; i < m->clip_count; i++) {
        clip_row(a, i);
    }
    ImGui::EndChild();
    tracks_list(a);
}
