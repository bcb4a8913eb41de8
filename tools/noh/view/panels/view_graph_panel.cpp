// view_graph_panel.cpp: the graphs of a pack: plays one on the body, with its parameters and states.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

namespace
{

void value_combo(view_app *a, const noh_pack_graph *g, const noh_pack_graph_param *p, uint32_t index)
{
    const char *name = noh_pack_string(g->pack, p->name);
    const uint32_t now = static_cast<uint32_t>(view_graph_parameter(a->model, index) + 0.5f);
    const char *shown = now < p->value_count ? noh_pack_string(g->pack, g->names[p->first_value + now].name) : "";
    if (!ui::begin_combo(name, shown)) {
        return;
    }
    const ui::in within(name);
    for (uint32_t v = 0; v < p->value_count; v++) {
        if (ui::selectable(noh_pack_string(g->pack, g->names[p->first_value + v].name), v == now)) {
            view_graph_set(a->model, index, static_cast<float>(v));
        }
    }
    ImGui::EndCombo();
}

void parameter(view_app *a, const noh_pack_graph *g, const noh_pack_graph_param *p)
{
    const char *name = noh_pack_string(g->pack, p->name);
    const uint32_t index = noh_stage_find(a->model->figure->stage, 0, NOH_NAME_PARAMETER, name);
    float value = view_graph_parameter(a->model, index);
    if (p->kind == NOH_PARAM_TRIGGER) {
        if (ui::button(name)) {
            view_graph_set(a->model, index, 1.0f);
        }
    } else if (p->kind == NOH_PARAM_ENUM) {
        value_combo(a, g, p, index);
    } else if (ui::slider(name, &value, p->minimum, p->maximum, p->kind == NOH_PARAM_INTEGER ? "%.0f" : "%.2f")) {
        view_graph_set(a->model, index, value);
    }
}

void states(view_app *a)
{
    noh_stage *stage = a->model->figure->stage;
    for (uint32_t i = 0; const char *name = noh_stage_name(stage, 0, NOH_NAME_MACHINE, i); i++) {
        const char *state = noh_actor_state(stage, a->model->figure->actors[0], i);
        if (state) {
            ImGui::Text("%s: %s", name, state);
        }
    }
}

} // namespace

void graph_section(view_app *a)
{
    noh_pack_graph g;
    const uint32_t playing = view_graph_playing(a->model);
    if (!a->model->has_graphs || !ui::section("Graph", false)) {
        return;
    }
    for (uint32_t i = 0; noh_pack_graph_at(&a->model->clips_of->pack, i, &g, nullptr) == NOH_OK; i++) {
        const ui::in row(g.name);
        ImGui::PushID(static_cast<int>(i));
        if (ui::small_button("play")) {
            view_graph_start(a, i);
        }
        ImGui::SameLine();
        ImGui::TextColored(i == playing ? amber : ImGui::GetStyleColorVec4(ImGuiCol_Text), "%s", g.name);
        ImGui::PopID();
    }
    if (noh_pack_graph_at(&a->model->clips_of->pack, playing, &g, nullptr) != NOH_OK) {
        return;
    }
    {
        const ui::in within("graph");
        const ui::labelled width;
        for (uint32_t p = 0; p < g.header->param_count; p++) {
            parameter(a, &g, &g.params[p]);
        }
    }
    states(a);
}
