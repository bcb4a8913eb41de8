// view_target_panel.cpp: the figure's name, undo and clipboard, presets, a slider for each target.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#include <cstring>

namespace
{

ImGuiTextFilter target_filter;
char preset_name[VIEW_PRESET_NAME];

const ImVec4 held_grab(0.70f, 0.50f, 0.22f, 1.0f);

// ---- names ----

// All of a name, however long: broken where the line ends.
void whole_name(const char *name, float width)
{
    const float letter = ImGui::CalcTextSize("m").x;
    const size_t in_line = width > 2.0f * letter ? static_cast<size_t>(width / letter) : 2;
    for (size_t at = 0, length = std::strlen(name); at < length; at += in_line) {
        ImGui::TextUnformatted(name + at, name + (at + in_line < length ? at + in_line : length));
    }
}

void head(view_app *a)
{
    const view_model *m = a->model;
    const char *name = std::strrchr(m->path, '/');
    ImGui::PushStyleColor(ImGuiCol_Text, amber);
    whole_name(name ? name + 1 : m->path, ImGui::GetContentRegionAvail().x);
    ImGui::PopStyleColor();
    ui::hint(m->path);
    ImGui::TextDisabled("%u mesh%s, %u target%s, %u clip%s", m->file.pack.runs[NOH_CHUNK_MESH].count,
                        m->file.pack.runs[NOH_CHUNK_MESH].count == 1 ? "" : "es", m->target_count,
                        m->target_count == 1 ? "" : "s", m->clip_count, m->clip_count == 1 ? "" : "s");
}

// ---- steps and the clipboard ----

bool when(bool possible, const char *label, float width)
{
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, possible ? 1.0f : 0.4f);
    const bool pressed = ui::button(label, width);
    ImGui::PopStyleVar();
    return pressed && possible;
}

void edit_buttons(view_app *a)
{
    const float width = (ImGui::GetContentRegionAvail().x - 12.0f) / 3.0f;
    if (when(a->undo.at > 0, "undo", width)) {
        view_undo(a);
    }
    ui::hint("Ctrl+Z");
    ImGui::SameLine();
    if (when(a->undo.at + 1 < a->undo.count, "redo", width)) {
        view_redo(a);
    }
    ui::hint("Ctrl+Shift+Z");
    ImGui::SameLine();
    if (ui::button("let go", width)) {
        for (uint32_t t = 0; t < a->model->target_count; t++) {
            view_target_let_go(&a->model->targets[t]);
        }
    }
    ui::hint("return all moved sliders to clips and face. Ctrl+C copies them as text, Ctrl+V pastes");
}

// ---- presets ----

// One after another, as many as fit in a line.
void preset_buttons(view_app *a)
{
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    for (uint32_t i = 0; i < a->presets.count; i++) {
        const view_preset &preset = a->presets.list[i];
        const float width = ImGui::CalcTextSize(preset.name).x + 2.0f * ImGui::GetStyle().FramePadding.x;
        if (i && ImGui::GetItemRectMax().x + 4.0f + width + (preset.own ? 24.0f : 0.0f) < right) {
            ImGui::SameLine(0.0f, 4.0f);
        }
        ImGui::PushID(static_cast<int>(i));
        ImGui::PushStyleColor(ImGuiCol_Text, preset.own ? amber : ImGui::GetStyleColorVec4(ImGuiCol_Text));
        if (ui::small_button(preset.name)) {
            view_presets_use(&a->presets, i, a->model);
        }
        ImGui::PopStyleColor();
        bool dropped = false;
        if (preset.own) {
            const ui::in own(preset.name);
            ImGui::SameLine(0.0f, 1.0f);
            dropped = ui::small_button("x");
            ui::hint("delete it from the file");
        }
        ImGui::PopID();
        if (dropped) {
            view_keep(a, view_presets_drop(&a->presets, i));
            break;
        }
    }
}

void presets_section(view_app *a)
{
    if (!a->model->target_count || !ui::section("Presets", a->presets.count > 0)) {
        return;
    }
    preset_buttons(a);
    ImGui::SetNextItemWidth(-60.0f);
    bool kept = ui::text_field("##preset", "a name for these weights", preset_name, sizeof preset_name);
    ImGui::SameLine();
    kept |= ui::button("keep", -1.0f);
    ui::hint(a->presets.path);
    if (kept) {
        const int status = view_presets_keep(&a->presets, a->model, preset_name);
        view_keep(a, status);
        if (!status) {
            preset_name[0] = 0;
        }
    }
}

// ---- sliders ----

void target_slider(view_target &target)
{
    ImGui::PushID(&target);
    const float width = ImGui::GetContentRegionAvail().x, slider = 96.0f;
    const bool held = target.held != 0; // as it began: the slider may change it
    const bool fits = ImGui::CalcTextSize(target.name).x < width - slider - 8.0f;
    if (held) {
        ImGui::PushStyleColor(ImGuiCol_SliderGrab, held_grab);
        ImGui::PushStyleColor(ImGuiCol_Text, amber);
    }
    if (!fits) { // a line of its own
        ImGui::BeginGroup();
        whole_name(target.name, width);
        ImGui::EndGroup();
        if (ImGui::IsItemClicked()) {
            view_target_let_go(&target);
        }
    }
    ImGui::SetNextItemWidth(slider);
    float value = target.value;
    if (ImGui::SliderFloat("##value", &value, 0.0f, 1.0f, "%.2f")) { // a value that is typed may lie beyond
        view_target_hold(&target, value);
    }
    ui::note(target.name);
    if (fits) {
        ImGui::SameLine();
        ImGui::TextUnformatted(target.name);
        if (ImGui::IsItemClicked()) {
            view_target_let_go(&target);
        }
    }
    ui::hint(held ? "held: click the name to release it. Ctrl-click the slider to type a value" : target.name);
    if (held) {
        ImGui::PopStyleColor(2);
    }
    ImGui::PopID();
}

void sliders(view_app *a)
{
    view_model *m = a->model;
    if (!m->target_count) {
        ImGui::TextDisabled("no targets to move");
        return;
    }
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::InputTextWithHint("##search", "search targets", target_filter.InputBuf, sizeof target_filter.InputBuf)) {
        target_filter.Build();
    }
    ui::note("search");
    ImGui::BeginChild("list");
    for (uint32_t t = 0; t < m->target_count; t++) {
        if (target_filter.PassFilter(m->targets[t].name)) {
            target_slider(m->targets[t]);
        }
    }
    ImGui::EndChild();
}

} // namespace

void targets_panel(view_app *a)
{
    begin_panel("targets", 0.0f, 0.0f, VIEW_LEFT, a->window.height);
    head(a);
    edit_buttons(a);
    presets_section(a);
    ImGui::Separator();
    sliders(a);
    ImGui::End();
}

void targets_forget()
{
    target_filter.Clear();
}
