// view_panels.cpp: the panels. Reads and changes view_app; requests what needs the GPU through `wish`.
#include "view/view_panels.h"
#include "view/view_imgui.h"

#include <cfloat>
#include <cstdio>
#include <cstring>

namespace
{

ImGuiTextFilter target_filter;
bool mouse_held;

// ---- a panel at a fixed place ----

bool begin_panel(const char *name, float x, float y, float width, float height)
{
    ImGui::SetNextWindowPos(ImVec2(x, y));
    ImGui::SetNextWindowSize(ImVec2(width, height));
    return ImGui::Begin(name, nullptr,
                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                            ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBringToFrontOnFocus);
}

// ---- targets ----

void let_go(view_target &target)
{
    target.let_go |= target.held;
    target.held = 0;
}

void target_slider(view_target &target)
{
    ImGui::PushID(&target);
    const float width = ImGui::GetContentRegionAvail().x;
    const bool held = target.held != 0; // as it began: the slider may change it
    if (held) {
        ImGui::PushStyleColor(ImGuiCol_SliderGrab, ImVec4(0.70f, 0.50f, 0.22f, 1.0f));
        ImGui::PushStyleColor(ImGuiCol_Text, amber);
    }
    ImGui::SetNextItemWidth(width * 0.45f);
    if (ImGui::SliderFloat("##value", &target.value, 0.0f, 1.0f, "%.2f")) {
        target.held = 1;
    }
    ImGui::SameLine();
    ImGui::TextUnformatted(target.name);
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s%s", target.name, held ? "\nheld: click to let go" : "");
    }
    if (ImGui::IsItemClicked()) {
        let_go(target);
    }
    if (held) {
        ImGui::PopStyleColor(2);
    }
    ImGui::PopID();
}

void targets_panel(view_app *a)
{
    view_model *m = a->model;
    begin_panel("targets", 0.0f, 0.0f, VIEW_LEFT, a->window_height);
    const char *name = std::strrchr(m->path, '/');
    ImGui::TextColored(amber, "%s", name ? name + 1 : m->path);
    ImGui::Text("meshes %u, targets %u, clips %u", m->file.pack.mesh_count, m->target_count, m->clip_count);
    ImGui::Separator();
    ImGui::SetNextItemWidth(-80.0f);
    if (ImGui::InputTextWithHint("##search", "search targets", target_filter.InputBuf, sizeof target_filter.InputBuf)) {
        target_filter.Build();
    }
    ImGui::SameLine();
    if (ImGui::Button("reset", ImVec2(-1.0f, 0.0f))) {
        for (uint32_t t = 0; t < m->target_count; t++) {
            let_go(m->targets[t]);
        }
    }
    ImGui::BeginChild("list");
    for (uint32_t t = 0; t < m->target_count; t++) {
        if (target_filter.PassFilter(m->targets[t].name)) {
            target_slider(m->targets[t]);
        }
    }
    ImGui::EndChild();
    ImGui::End();
}

// ---- clips ----

void clip_row(view_app *a, uint32_t clip)
{
    const view_clip &c = a->model->clips[clip];
    ImGui::PushID(static_cast<int>(clip));
    if (ImGui::SmallButton("play")) {
        view_play(a, clip, 0);
    }
    ImGui::SameLine();
    if (ImGui::SmallButton("add")) {
        view_play(a, clip, 1);
    }
    ImGui::SameLine();
    ImGui::Text("%s", c.name);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 64.0f);
    ImGui::TextDisabled("%7.2f s", c.seconds);
    ImGui::PopID();
}

void clips_section(view_app *a)
{
    view_model *m = a->model;
    if (!ImGui::CollapsingHeader("Clips", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    if (!m->clip_count) {
        ImGui::TextDisabled("none in this file");
        return;
    }
    if (ImGui::Button(a->playing ? "pause" : "play", ImVec2(60.0f, 0.0f))) {
        view_toggle_play(a);
    }
    ImGui::SameLine();
    if (ImGui::Button("stop all")) {
        view_stop_all(m);
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::SliderFloat("##speed", &a->speed, 0.0f, 2.0f, "speed %.2f", ImGuiSliderFlags_AlwaysClamp);
    const float rows = m->clip_count < 6 ? static_cast<float>(m->clip_count) : 6.0f;
    ImGui::BeginChild("clips", ImVec2(0.0f, rows * ImGui::GetTextLineHeightWithSpacing() + 4.0f));
    for (uint32_t i = 0; i < m->clip_count; i++) {
        clip_row(a, i);
    }
    ImGui::EndChild();
    tracks_list(a);
}

// ---- drawing ----

void path_combo(view_app *a)
{
    if (ImGui::BeginCombo("path", noh_morph_path_name(a->desc.morph_path))) {
        for (int i = 0; i < NOH_MORPH_PATH_COUNT; i++) {
            const noh_morph_path path = static_cast<noh_morph_path>(i);
            if (ImGui::Selectable(noh_morph_path_name(path), path == a->desc.morph_path)) {
                a->wish.morph_path = path;
                a->wants_reload = 1;
            }
        }
        ImGui::EndCombo();
    }
}

void accumulate_combo(view_app *a)
{
    if (ImGui::BeginCombo("accumulators", noh_accumulate_name(a->desc.accumulate))) {
        for (int i = 0; i < 3; i++) {
            const noh_accumulate format = static_cast<noh_accumulate>(i);
            if (ImGui::Selectable(noh_accumulate_name(format), format == a->desc.accumulate)) {
                a->wish.accumulate = format;
                a->wants_reload = 1;
            }
        }
        ImGui::EndCombo();
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
    if (ImGui::Combo("wrinkles", &model, models, 4)) {
        a->lod.wrinkle_models = bits[model];
    }
    ImGui::SliderFloat("##wrinkled", &a->lod.wrinkles, 0.0f, 1.0f, "wrinkled %.2f", ImGuiSliderFlags_AlwaysClamp);
}

void drawing_section(view_app *a)
{
    static const char *const views[] = {
        "lit", "position", "normal", "tangent", "lod", "light", "occlusion", "wrinkle"
    };
    int view = static_cast<int>(a->desc.view);
    bool bones = a->model->show_bones != 0;
    if (!ImGui::CollapsingHeader("Drawing", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x - 110.0f);
    path_combo(a);
    accumulate_combo(a);
    if (ImGui::Combo("view", &view, views, 8)) {
        a->wish.view = static_cast<noh_debug_view>(view);
        a->wants_reload = 1;
    }
    if (a->model->file.pack.wrinkles_count) {
        wrinkle_controls(a);
    }
    ImGui::PopItemWidth();
    if (a->model->file.pack.skeleton_count && ImGui::Checkbox("bones", &bones)) {
        a->wish.show_bones = bones;
        a->wants_reload = 1;
    }
    if (a->model->file.pack.skeleton_count) {
        bool follow = a->follow != 0;
        ImGui::SameLine();
        if (ImGui::Checkbox("follow", &follow)) {
            a->follow = follow;
        }
    }
    if (a->model->is_morphed) {
        const noh_gl_morph_plan *plan = &a->model->morph_plan;
        ImGui::TextWrapped("%s-%s (%s)", noh_morph_path_name(plan->path), noh_accumulate_name(plan->accumulate),
                           plan->reason);
    }
}

// ---- light ----

void light_section(view_app *a)
{
    static const char *const backgrounds[] = { "plain", "gradient", "light" };
    lighting *light = a->desc.light;
    if (!light || !ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    float degrees = static_cast<float>(light->degrees);
    int background = static_cast<int>(light->background);
    bool filmic = light->told.tonemap == NOH_TONEMAP_FILMIC;
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::SliderFloat("##turn", &degrees, -180.0f, 180.0f, "turned by %.0f degrees",
                           ImGuiSliderFlags_AlwaysClamp)) {
        lighting_turn(light, static_cast<double>(degrees));
    }
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x - 110.0f);
    if (ImGui::Combo("background", &background, backgrounds, 3)) {
        light->background = static_cast<lighting_background>(background);
    }
    ImGui::PopItemWidth();
    if (ImGui::Checkbox("filmic", &filmic)) {
        light->told.tonemap = filmic ? NOH_TONEMAP_FILMIC : NOH_TONEMAP_NONE;
    }
}

// ---- times, memory, layers ----

void time_row(const char *name, double ms, const char *what)
{
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    ImGui::TableNextColumn();
    if (ms < 0.0) {
        ImGui::TextDisabled("       -");
    } else {
        ImGui::Text("%8.3f", ms);
    }
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", what);
}

void times_section(view_app *a)
{
    const view_times &t = a->times;
    if (!ImGui::CollapsingHeader("Times", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    if (ImGui::BeginTable("times", 3, ImGuiTableFlags_SizingFixedFit)) {
        time_row("frame", t.frame, "ms, to the next");
        time_row("animate", t.animate, "ms, CPU: clips and poses");
        time_row("accumulate", t.accumulate, "ms, GPU: morph targets");
        time_row("draw", t.draw, "ms, GPU: the figure");
        ImGui::EndTable();
    }
    ImGui::PlotLines("##frames", t.frame_ms, VIEW_HISTORY, static_cast<int>(t.next), nullptr, 0.0f, FLT_MAX,
                     ImVec2(ImGui::GetContentRegionAvail().x, 36.0f));
    const noh_stage_stats *stats = noh_stage_stats_of(a->model->figure->stage);
    ImGui::TextDisabled("posed %u of %u, decoded %llu track-frames, %llu late", stats->updated, stats->actors,
                        static_cast<unsigned long long>(stats->decoded),
                        static_cast<unsigned long long>(stats->decoded_late));
}

void memory_row(const char *name, uint64_t cpu, uint64_t gpu)
{
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    ImGui::TableNextColumn();
    ImGui::Text("%11llu", static_cast<unsigned long long>(cpu));
    ImGui::TableNextColumn();
    ImGui::Text("%11llu", static_cast<unsigned long long>(gpu));
}

void memory_section(view_app *a)
{
    const view_model *m = a->model;
    const noh_stage_plan *plan = &m->figure->plan;
    if (!ImGui::CollapsingHeader("Memory", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    if (ImGui::BeginTable("memory", 3, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) {
        ImGui::TableSetupColumn("bytes");
        ImGui::TableSetupColumn("        CPU");
        ImGui::TableSetupColumn("        GPU");
        ImGui::TableHeadersRow();
        for (uint32_t i = 0; i < m->part_count; i++) {
            if (m->parts[i].cpu_bytes || m->parts[i].gpu_bytes) {
                memory_row(m->parts[i].what, m->parts[i].cpu_bytes, m->parts[i].gpu_bytes);
            }
        }
        memory_row("sum", plan->cpu_bytes, plan->gpu_bytes);
        if (m->costs.count > 1 && a->lod.finest < m->costs.count) {
            const level_cost &cost = m->costs.levels[a->lod.finest];
            char name[32];
            snprintf(name, sizeof name, "from level %u on", a->lod.finest);
            memory_row(name, cost.cpu_bytes, cost.gpu_bytes);
        }
        memory_row("on the GPU now", 0, noh_gl_ledger_bytes(&a->gpu.ledger));
        memory_row("the pack", plan->pack_bytes, 0);
        ImGui::EndTable();
    }
}

// The accumulated layers, or what they are accumulated from.
void data_combo(view_app *a)
{
    noh_mesh mesh;
    if (!view_data_mesh(a->model, &mesh)) {
        return;
    }
    const auto name_of = [&mesh](uint32_t i) { return noh_pack_string(mesh.pack, mesh.targets[i].name); };
    const bool has_target = a->data_target < mesh.header->target_count;
    const char *shown = a->data == VIEW_DATA_SUMS   ? "sums"
                        : a->data == VIEW_DATA_BASE ? "base"
                        : has_target                ? name_of(a->data_target)
                                                    : "";
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::BeginCombo("##data", shown)) {
        if (ImGui::Selectable("sums", a->data == VIEW_DATA_SUMS)) a->data = VIEW_DATA_SUMS;
        if (ImGui::Selectable("base", a->data == VIEW_DATA_BASE)) a->data = VIEW_DATA_BASE;
        for (uint32_t i = 0; i < mesh.header->target_count; i++) {
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(name_of(i), a->data == VIEW_DATA_DELTA && i == a->data_target)) {
                a->data = VIEW_DATA_DELTA;
                a->data_target = i;
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
}

void layers_section(view_app *a)
{
    static const char *const names[] = { "position", "normal", "tangent" };
    a->show_layers = ImGui::CollapsingHeader("Accumulators", ImGuiTreeNodeFlags_DefaultOpen);
    if (!a->show_layers) {
        return;
    }
    if (!a->model->is_morphed || !a->screen.layers_width) {
        ImGui::TextDisabled("no accumulators");
        return;
    }
    data_combo(a);
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::SliderFloat("##gain", &a->layer_gain, 0.1f, 20.0f, "gain %.2f", ImGuiSliderFlags_Logarithmic);
    const float width = (ImGui::GetContentRegionAvail().x - 8.0f) / 3.0f;
    const float height = width * static_cast<float>(a->screen.layers_height) /
                         static_cast<float>(a->screen.layers_width);
    for (int i = 0; i < 3; i++) {
        ImGui::BeginGroup();
        ImGui::Image(imgui_texture(a->screen.layers[i]), ImVec2(width, height));
        ImGui::TextDisabled("%s", names[i]);
        ImGui::EndGroup();
        if (i < 2) {
            ImGui::SameLine(0.0f, 4.0f);
        }
    }
}

void right_panel(view_app *a)
{
    begin_panel("figure", a->window_width - VIEW_RIGHT, 0.0f, VIEW_RIGHT, a->window_height);
    clips_section(a);
    how_section(a);
    pad_section(a);
    floor_section(a);
    graph_section(a);
    lod_section(a);
    drawing_section(a);
    light_section(a);
    times_section(a);
    layers_section(a);
    memory_section(a);
    ImGui::End();
}

// ---- events ----

void events_panel(view_app *a)
{
    begin_panel("events", VIEW_LEFT, a->window_height - VIEW_BOTTOM, a->window_width - VIEW_LEFT - VIEW_RIGHT,
                VIEW_BOTTOM);
    if (a->message[0]) {
        ImGui::PushStyleColor(ImGuiCol_Text, red);
        ImGui::TextWrapped("%s", a->message);
        ImGui::PopStyleColor();
    } else if (a->pick.is_on) {
        char text[512];
        view_pick_text(&a->pick, a->model, text, sizeof text);
        ImGui::TextColored(amber, "%s", text);
    } else {
        ImGui::TextDisabled(
            "space play  click pick  Alt-click or P push  drag turn  wheel zoom  F fit  L detail  [ ] light  Tab hide  F12 save");
    }
    ImGui::Separator();
    ImGui::BeginChild("lines");
    const uint32_t count = a->log.total < VIEW_LINES ? a->log.total : VIEW_LINES;
    for (uint32_t i = 0; i < count; i++) {
        ImGui::TextUnformatted(a->log.lines[(a->log.next + VIEW_LINES - count + i) % VIEW_LINES]);
    }
    if (!count) {
        ImGui::TextDisabled("callback keys that the clips pass are listed here");
    }
    if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) {
        ImGui::SetScrollHereY(1.0f); // follow, unless the user scrolled up
    }
    ImGui::EndChild();
    ImGui::End();
}

} // namespace

int view_panels_open(void)
{
    return imgui_open();
}

void view_panels_close(void)
{
    target_filter.Clear();
    imgui_close();
}

void view_panels_frame(view_app *a, const view_input *input, double seconds)
{
    imgui_begin(a, input, seconds);
    if (a->show_panels) {
        targets_panel(a);
        right_panel(a);
        events_panel(a);
    }
    mouse_held = ImGui::IsAnyItemActive() || ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup);
    imgui_end(a);
}

int view_panels_hold_mouse(void)
{
    return mouse_held;
}

int view_panels_want_keys(void)
{
    return ImGui::GetIO().WantTextInput;
}
