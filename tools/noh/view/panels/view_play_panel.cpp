// view_play_panel.cpp: what plays, layer by layer; how the next clip plays.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#include <cstdio>
#include <cstring>

namespace
{

// ---- tracks ----

// A slider for a weight or speed: at once, or, with ramps, from when it is let go.
void track_slider(view_app *a, uint32_t kind, uint32_t track, noh_change_kind what, float now, float least, float most,
                  const char *label)
{
    static float wanted;
    static ImGuiID ramped;
    const ImGuiID id = ImGui::GetID(label);
    float value = ramped == id ? wanted : now;
    const bool moved = ui::slider(label, &value, least, most, what == NOH_CHANGE_WEIGHT ? "weight %.2f" : "speed %.2f");
    if (moved && a->ramps) {
        wanted = value;
        ramped = id;
    } else if (moved && what == NOH_CHANGE_WEIGHT) {
        view_set_weight(a->model, kind, track, value);
    } else if (moved) {
        view_set_speed(a->model, kind, track, value);
    }
    if (ramped == id && !ImGui::IsItemActive()) {
        view_ramp(a->model, kind, track, what, wanted, a->how.fade_s);
        ramped = 0;
    }
}

// Its name, whether it is posed, and stop.
bool track_head(view_app *a, uint32_t kind, uint32_t track)
{
    const noh_track *t = noh_controller_track(view_controller(a->model, kind, nullptr), track);
    const bool muted = t->mode == NOH_TRACK_TIME_ONLY;
    ImGui::TextColored(muted ? ImVec4(0.5f, 0.5f, 0.5f, 1.0f) : amber, "%s %s", view_layer_names[view_layer_of(track)],
                       view_clip_name(a->model, kind, t->clip));
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 84.0f);
    if (ui::small_button(muted ? "pose" : "mute")) {
        view_set_mode(a->model, kind, track, muted ? NOH_TRACK_ON : NOH_TRACK_TIME_ONLY);
    }
    ui::hint("muted: its time runs and its keys fire, but it does not affect the pose");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 40.0f);
    return ui::small_button("stop");
}

void track_sliders(view_app *a, uint32_t kind, uint32_t track)
{
    const noh_clip_set *set;
    const noh_track *t = noh_controller_track(view_controller(a->model, kind, &set), track);
    float at = static_cast<float>(view_position(a->model, kind, track));
    const float end = static_cast<float>(set->clips[t->clip].duration_ticks) / NOH_TICKS_PER_SECOND;
    ImGui::SetNextItemWidth(-1.0f);
    if (ui::slider("##at", &at, 0.0f, end, "%.3f s")) {
        view_seek(a->model, kind, track, static_cast<double>(at));
    }
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.5f - 4.0f);
    track_slider(a, kind, track, NOH_CHANGE_WEIGHT, t->weight, 0.0f, 1.0f, "##weight");
    ImGui::SameLine();
    track_slider(a, kind, track, NOH_CHANGE_SPEED, static_cast<float>(t->speed_now) / NOH_SPEED_ONE, -2.0f, 2.0f,
                 "##speed");
    ImGui::PopItemWidth();
}

void track_row(view_app *a, uint32_t kind, uint32_t track)
{
    const noh_track *t = noh_controller_track(view_controller(a->model, kind, nullptr), track);
    char name[NOH_NAME_BYTES_MAX];
    snprintf(name, sizeof name, "%s %s", view_layer_names[view_layer_of(track)],
             view_clip_name(a->model, kind, t->clip));
    const ui::in row(name);
    ImGui::PushID(static_cast<int>(kind * NOH_TRACKS_MAX + track));
    const bool stop = track_head(a, kind, track);
    if (view_clip_of(a->model, kind, t)) {
        track_sliders(a, kind, track);
    }
    if (stop) {
        view_stop_track(a->model, kind, track);
    }
    ImGui::PopID();
}

// ---- how the next clip plays ----

void layer_combo(view_app *a)
{
    const char *names[VIEW_LAYERS + 1] = { "auto" };
    for (uint32_t i = 0; i < VIEW_LAYERS; i++) {
        names[i + 1] = view_layer_names[i];
    }
    int at = static_cast<int>(a->how.layer);
    if (ui::choose("layer", &at, names, VIEW_LAYERS + 1)) {
        a->how.layer = static_cast<uint32_t>(at);
    }
}

void set_part(view_app *a, const char *joint)
{
    snprintf(a->part, sizeof a->part, "%s", joint);
    a->request.reload = 1;
}

// The mask of the layer "part".
void part_combo(view_app *a)
{
    noh_stage *stage = a->model->figure->stage;
    if (!a->model->file.pack.runs[NOH_CHUNK_SKELETON].count ||
        !ui::begin_combo("part, from", a->part[0] ? a->part : "no joint")) {
        return;
    }
    const ui::in within("part, from");
    if (ui::selectable("no joint", !a->part[0])) {
        set_part(a, "");
    }
    for (uint32_t i = 0; const char *name = noh_stage_name(stage, 0, NOH_NAME_JOINT, i); i++) {
        ImGui::PushID(static_cast<int>(i));
        if (ui::selectable(name, std::strcmp(name, a->part) == 0)) {
            set_part(a, name);
        }
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void layer_rows(view_app *a)
{
    static const char *const masks[VIEW_LAYERS] = { "all joints and floats", "these joints, over the body",
                                                    "floats, over the body", "added to what is below" };
    for (uint32_t i = 0; i < VIEW_LAYERS; i++) {
        const ui::in row(view_layer_names[i]);
        ImGui::PushID(static_cast<int>(i));
        ImGui::Text("%s", view_layer_names[i]);
        ImGui::SameLine(50.0f);
        ImGui::TextDisabled("%s", masks[i]);
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 64.0f);
        if (ui::small_button("fade out")) {
            view_stop_layer(a->model, i, a->how.fade_s);
        }
        ImGui::PopID();
    }
}

} // namespace

void tracks_list(view_app *a)
{
    for (uint32_t kind = 0; kind < a->model->figure->stage_desc.kind_count; kind++) {
        const noh_controller *c = view_controller(a->model, kind, nullptr);
        for (uint32_t t = 0; t < c->track_count; t++) {
            if (noh_controller_track(c, t)->mode != NOH_TRACK_OFF && !view_pad_plays(&a->pad, kind, t)) {
                track_row(a, kind, t);
            }
        }
    }
}

void how_section(view_app *a)
{
    static const char *const loops[] = { "the clip's own", "once", "repeat", "ping-pong" };
    view_how *how = &a->how;
    int loop = static_cast<int>(how->loop), group = static_cast<int>(how->sync_group);
    if (!a->model->clip_count || !ui::section("Layers", false)) {
        return;
    }
    const ui::in within("next");
    layer_rows(a);
    ImGui::TextDisabled("the next clip:");
    const ui::labelled width;
    layer_combo(a);
    part_combo(a);
    ui::slider("fade", &how->fade_s, 0.0f, 2.0f, "%.2f s");
    ui::slider("weight", &how->weight, 0.01f, 1.0f, "%.2f");
    ui::slider("speed", &how->speed, -2.0f, 2.0f, "%.2f");
    if (ui::choose("loop", &loop, loops, 4)) {
        how->loop = static_cast<noh_loop>(loop);
    }
    if (ui::slider("sync group", &group, 0, NOH_SYNC_GROUPS_MAX, group ? "%d" : "none")) {
        how->sync_group = static_cast<uint32_t>(group);
    }
    ui::checkbox("by inertia", &how->inertia);
    ImGui::SameLine();
    ui::checkbox("ramps", &a->ramps);
    ui::hint("tracks follow their sliders smoothly, over the time of a fade");
}
