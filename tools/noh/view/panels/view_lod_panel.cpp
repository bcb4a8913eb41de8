// view_lod_panel.cpp: the switch for LOD levels, with the cost of each.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#include <cstdio>

namespace
{

// The largest error of any kind of the figure, millimetres.
double level_error_mm(const view_model *m, uint32_t level)
{
    double most = 0.0;
    for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) {
        const noh_kind_plan &plan = m->figure->plan.kinds[k];
        const uint32_t last = plan.level_count - 1;
        const double error = 1e3 * static_cast<double>(plan.levels[level < last ? level : last].error_m);
        most = error > most ? error : most;
    }
    return most;
}

void level_row(view_app *a, uint32_t level)
{
    const level_cost &cost = a->model->costs.levels[level];
    view_lod *d = &a->lod;
    char name[24];
    snprintf(name, sizeof name, level ? "level %u" : "full", level);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const bool shown = level >= d->finest && level <= d->coarsest;
    if (shown) {
        ImGui::PushStyleColor(ImGuiCol_Text, amber);
    }
    if (ui::selectable(name, !d->by_pixels && d->level == level, ImGuiSelectableFlags_SpanAllColumns)) {
        view_lod_level(d, level);
    }
    const unsigned long long numbers[] = { cost.triangles, cost.texels, cost.pairs, cost.gpu_bytes };
    const char *const formats[] = { "%7llu", "%6llu", "%6llu", "%8llu" };
    for (int i = 0; i < 4; i++) {
        ImGui::TableNextColumn();
        ImGui::Text(formats[i], numbers[i]);
    }
    ImGui::TableNextColumn();
    ImGui::Text("%5.2f", level_error_mm(a->model, level));
    if (shown) {
        ImGui::PopStyleColor();
    }
}

void level_table(view_app *a)
{
    static const char *const heads[] = { "", "triang.", "texels", " pairs", "     GPU", "   mm" };
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(3.0f, 2.0f));
    const bool open = ImGui::BeginTable("levels", 6, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg);
    ImGui::PopStyleVar();
    if (!open) {
        return;
    }
    for (const char *head : heads) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", head);
    }
    for (uint32_t k = a->model->costs.first; k < a->model->costs.count; k++) {
        level_row(a, k);
    }
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (ui::selectable("by pixels", a->lod.by_pixels != 0, ImGuiSelectableFlags_SpanAllColumns)) {
        view_lod_pixels(&a->lod);
    }
    ImGui::EndTable();
}

} // namespace

void lod_section(view_app *a)
{
    view_lod *d = &a->lod;
    char text[96];
    if (a->model->costs.count < 2 || !ui::section("Detail", true)) {
        return;
    }
    level_table(a);
    ImGui::SetNextItemWidth(-1.0f);
    if (ui::slider("##pixels", &d->pixels, VIEW_PIXELS_LEAST, VIEW_PIXELS_MOST, "%.2f pixels allowed",
                   ImGuiSliderFlags_Logarithmic)) {
        view_lod_pixels(d);
    }
    view_lod_text(d, text, sizeof text);
    ImGui::TextColored(amber, "%s", d->coarsest || d->fading ? text : "full,"); // as in the table
    ImGui::SameLine();
    ImGui::Text("off by at most %.2f pixels", static_cast<double>(d->error_px));
    if (d->by_pixels) { // also when empty, so that what is below does not move
        ImGui::Text("%u weights of targets are drawn", d->weights);
    }
}
