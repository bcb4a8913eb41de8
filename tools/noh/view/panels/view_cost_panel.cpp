// view_cost_panel.cpp: times, memory, and the data textures.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#include <cfloat>
#include <cstdio>

namespace
{

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

// The accumulated layers, or what they are accumulated from.
void data_combo(view_app *a)
{
    noh_mesh mesh;
    if (!view_data_mesh(a->model, &mesh)) {
        return;
    }
    const auto name_of = [&mesh](uint32_t i) { return noh_pack_string(mesh.pack, mesh.targets[i].name); };
    const bool has_target = a->textures.target < mesh.header->target_count;
    const char *shown = a->textures.shown == VIEW_DATA_SUMS   ? "sums"
                        : a->textures.shown == VIEW_DATA_BASE ? "base"
                        : has_target                          ? name_of(a->textures.target)
                                                              : "";
    ImGui::SetNextItemWidth(-1.0f);
    if (ui::begin_combo("##data", shown)) {
        if (ImGui::Selectable("sums", a->textures.shown == VIEW_DATA_SUMS)) a->textures.shown = VIEW_DATA_SUMS;
        if (ImGui::Selectable("base", a->textures.shown == VIEW_DATA_BASE)) a->textures.shown = VIEW_DATA_BASE;
        for (uint32_t i = 0; i < mesh.header->target_count; i++) {
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(name_of(i), a->textures.shown == VIEW_DATA_DELTA && i == a->textures.target)) {
                a->textures.shown = VIEW_DATA_DELTA;
                a->textures.target = i;
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
}

} // namespace

void times_section(view_app *a)
{
    const view_times &t = a->times;
    if (!ui::section("Times", false)) {
        return;
    }
    if (ImGui::BeginTable("times", 3, ImGuiTableFlags_SizingFixedFit)) {
        time_row("frame", t.frame, "ms per frame");
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

void memory_section(view_app *a)
{
    const view_model *m = a->model;
    const noh_stage_plan *plan = &m->figure->plan;
    if (!ui::section("Memory", false)) {
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

void layers_section(view_app *a)
{
    static const char *const names[] = { "position", "normal", "tangent" };
    a->window.show_layers = ui::section("Accumulators", a->textures.shown != VIEW_DATA_SUMS);
    if (!a->window.show_layers) {
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
