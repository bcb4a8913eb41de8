// view_play_panel.cpp: what plays, layer by layer; how the next clip plays; the floor.
#include "view/view_panels.h"
#include "view/view_imgui.h"

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
    const bool moved = ImGui::SliderFloat(label, &value, least, most,
                                          what == NOH_CHANGE_WEIGHT ? "weight %.2f" : "speed %.2f",
                                          ImGuiSliderFlags_AlwaysClamp);
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
    if (ImGui::SmallButton(muted ? "pose" : "mute")) {
        view_set_mode(a->model, kind, track, muted ? NOH_TRACK_ON : NOH_TRACK_TIME_ONLY);
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("muted: its time goes on and its keys fire, but it is not in the pose");
    }
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 40.0f);
    return ImGui::SmallButton("stop");
}

void track_sliders(view_app *a, uint32_t kind, uint32_t track)
{
    const noh_clip_set *set;
    const noh_track *t = noh_controller_track(view_controller(a->model, kind, &set), track);
    float at = static_cast<float>(view_position(a->model, kind, track));
    const float end = static_cast<float>(set->clips[t->clip].duration_ticks) / NOH_TICKS_PER_SECOND;
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::SliderFloat("##at", &at, 0.0f, end, "%.3f s", ImGuiSliderFlags_AlwaysClamp)) {
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
    uint32_t *layer = &a->how.layer;
    if (ImGui::BeginCombo("layer", *layer ? view_layer_names[*layer - 1] : "auto")) {
        if (ImGui::Selectable("auto", !*layer)) {
            *layer = 0;
        }
        for (uint32_t i = 0; i < VIEW_LAYERS; i++) {
            if (ImGui::Selectable(view_layer_names[i], *layer == i + 1)) {
                *layer = i + 1;
            }
        }
        ImGui::EndCombo();
    }
}

void set_part(view_app *a, const char *joint)
{
    snprintf(a->part, sizeof a->part, "%s", joint);
    a->wants_reload = 1;
}

// The mask of the layer "part".
void part_combo(view_app *a)
{
    noh_stage *stage = a->model->figure->stage;
    if (!a->model->file.pack.skeleton_count || !ImGui::BeginCombo("part, from", a->part[0] ? a->part : "no joint")) {
        return;
    }
    if (ImGui::Selectable("no joint", !a->part[0])) {
        set_part(a, "");
    }
    for (uint32_t i = 0; const char *name = noh_stage_name(stage, 0, NOH_NAME_JOINT, i); i++) {
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable(name, std::strcmp(name, a->part) == 0)) {
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
        ImGui::PushID(static_cast<int>(i));
        ImGui::Text("%s", view_layer_names[i]);
        ImGui::SameLine(50.0f);
        ImGui::TextDisabled("%s", masks[i]);
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 64.0f);
        if (ImGui::SmallButton("fade out")) {
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
    bool inertia = how->inertia != 0, ramps = a->ramps != 0;
    if (!a->model->clip_count || !ImGui::CollapsingHeader("Layers")) {
        return;
    }
    layer_rows(a);
    ImGui::TextDisabled("the next clip:");
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x - 110.0f);
    layer_combo(a);
    part_combo(a);
    ImGui::SliderFloat("fade", &how->fade_s, 0.0f, 2.0f, "%.2f s", ImGuiSliderFlags_AlwaysClamp);
    ImGui::SliderFloat("weight", &how->weight, 0.01f, 1.0f, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    ImGui::SliderFloat("speed", &how->speed, -2.0f, 2.0f, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::Combo("loop", &loop, loops, 4)) {
        how->loop = static_cast<noh_loop>(loop);
    }
    if (ImGui::SliderInt("sync group", &group, 0, NOH_SYNC_GROUPS_MAX, group ? "%d" : "none")) {
        how->sync_group = static_cast<uint32_t>(group);
    }
    ImGui::PopItemWidth();
    if (ImGui::Checkbox("by inertia", &inertia)) {
        how->inertia = inertia;
    }
    ImGui::SameLine();
    if (ImGui::Checkbox("ramps", &ramps)) {
        a->ramps = ramps;
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("sliders of tracks are followed smoothly, within the time of a fade");
    }
}

void floor_section(view_app *a)
{
    const noh_place place = view_model_place(a->model);
    bool floor = a->show_floor != 0, walks = a->model->root_motion != 0;
    if (!a->model->file.pack.skeleton_count || !ImGui::CollapsingHeader("Floor")) {
        return;
    }
    if (ImGui::Checkbox("floor", &floor)) {
        a->show_floor = floor;
    }
    ImGui::SameLine();
    if (ImGui::Checkbox("root motion", &walks)) {
        view_walk(a, walks);
    }
    ImGui::SameLine();
    if (ImGui::Button("back to the start", ImVec2(-1.0f, 0.0f))) {
        view_walk_home(a);
    }
    if (ImGui::Button("push")) {
        view_push(a);
    }
    ImGui::SameLine();
    ImGui::Text("at %.3f %.3f", static_cast<double>(place.position[0]), static_cast<double>(place.position[2]));
}
