#include "view/panels/view_widgets.h"

#include <cstdio>
#include <cstring>
#include <initializer_list>

namespace
{

const size_t names_max = 2048;

struct noted {
    char name[160];
    float box[4];
    bool seen; // its middle is in the part of its panel that is drawn
};

noted notes[2][names_max]; // of this frame, and of the last
size_t note_count[2];
int now;
bool noting, escaped;
char around[160], wanted[160];

// "play##pad" is called "play"; "##value" is called "value".
void called(const char *label, char *name, size_t bytes)
{
    const char *hash = std::strstr(label, "##");
    const char *from = hash == label ? label + 2 : label;
    const size_t before = std::strlen(around);
    size_t length = hash && hash != label ? static_cast<size_t>(hash - label) : std::strlen(from);
    std::memcpy(name, around, before);
    length = length < bytes - before ? length : bytes - before - 1;
    std::memcpy(name + before, from, length);
    name[before + length] = 0;
}

// By its whole name, or by the last parts of it: "play" or "walk/play" for "clips/walk/play".
bool is_named(const noted &n, const char *name, bool whole)
{
    const size_t length = std::strlen(name), full = std::strlen(n.name);
    if (whole || full <= length) {
        return std::strcmp(n.name, name) == 0;
    }
    return n.name[full - length - 1] == '/' && std::strcmp(n.name + full - length, name) == 0;
}

} // namespace

namespace ui
{

in::in(const char *name) : length(std::strlen(around))
{
    snprintf(around + length, sizeof around - length, "%s/", name);
}

in::~in()
{
    around[length] = 0;
}

void begin_frame(bool is_noting, bool escape)
{
    escaped = escape;
    noting = is_noting;
    now = 1 - now;
    note_count[now] = 0;
}

void want(const char *name)
{
    snprintf(wanted, sizeof wanted, "%s", name);
}

int find(const char *name, float box[4])
{
    for (const bool whole : std::initializer_list<bool>{ true, false }) {
        for (size_t i = 0; i < note_count[now]; i++) {
            if (is_named(notes[now][i], name, whole)) {
                std::memcpy(box, notes[now][i].box, sizeof notes[now][i].box);
                return notes[now][i].seen ? 1 : 2;
            }
        }
    }
    return 0;
}

void note(const char *label)
{
    if (!noting || note_count[now] == names_max) {
        return;
    }
    noted &n = notes[now][note_count[now]++];
    called(label, n.name, sizeof n.name);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 from = ImGui::GetWindowDrawList()->GetClipRectMin(), to = ImGui::GetWindowDrawList()->GetClipRectMax();
    const float x = 0.5f * (low.x + high.x), y = 0.5f * (low.y + high.y);
    n.box[0] = low.x;
    n.box[1] = low.y;
    n.box[2] = high.x;
    n.box[3] = high.y;
    const float left = ImGui::GetWindowPos().x, right = left + ImGui::GetWindowSize().x; // a row of a table is clipped
    n.seen = x > left && x < right && y > from.y && y < to.y;
    if (wanted[0] && is_named(n, wanted, false)) {
        if (low.y < from.y || high.y > to.y) {
            ImGui::SetScrollHereY(0.5f);
        }
        wanted[0] = 0;
    }
}

bool button(const char *label, float width)
{
    const bool pressed = ImGui::Button(label, ImVec2(width, 0.0f));
    note(label);
    return pressed;
}

bool small_button(const char *label)
{
    const bool pressed = ImGui::SmallButton(label);
    note(label);
    return pressed;
}

bool checkbox(const char *label, int *on)
{
    bool checked = *on != 0;
    const bool changed = ImGui::Checkbox(label, &checked);
    note(label);
    *on = checked;
    return changed;
}

bool slider(const char *label, float *value, float least, float most, const char *format, int flags)
{
    const bool changed = ImGui::SliderFloat(label, value, least, most, format, flags | ImGuiSliderFlags_AlwaysClamp);
    note(label);
    return changed;
}

bool slider(const char *label, int *value, int least, int most, const char *format)
{
    const bool changed = ImGui::SliderInt(label, value, least, most, format);
    note(label);
    return changed;
}

bool selectable(const char *label, bool chosen, int flags)
{
    const bool pressed = ImGui::Selectable(label, chosen, flags);
    note(label);
    return pressed;
}

bool section(const char *label, bool open_at_first)
{
    const bool open = ImGui::CollapsingHeader(label, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    note(label);
    return open;
}

bool text_field(const char *label, const char *hint_text, char *text, size_t bytes)
{
    const bool entered = ImGui::InputTextWithHint(label, hint_text, text, bytes, ImGuiInputTextFlags_EnterReturnsTrue);
    note(label);
    return entered;
}

bool begin_combo(const char *label, const char *shown)
{
    const bool open = ImGui::BeginCombo(label, shown, ImGuiComboFlags_HeightLarge);
    if (!open) {
        note(label);
    } else if (escaped) {
        ImGui::CloseCurrentPopup();
    }
    return open;
}

bool choose(const char *label, int *at, const char *const *names, int count)
{
    bool changed = false;
    if (!begin_combo(label, *at >= 0 && *at < count ? names[*at] : "")) {
        return false;
    }
    const in within(label);
    for (int i = 0; i < count; i++) {
        if (selectable(names[i], i == *at) && i != *at) {
            *at = i;
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

void hint(const char *text)
{
    if (ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(320.0f);
        ImGui::TextUnformatted(text);
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
}

labelled::labelled()
{
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x - 110.0f);
}

labelled::~labelled()
{
    ImGui::PopItemWidth();
}

} // namespace ui
