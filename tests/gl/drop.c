/* drop.c: `drop WINDOW FILE` drops a file on an X11 window as a file manager does (XDND, version 5).
 * Exit code 0 if the window accepted it. view.sh compiles and uses it. */
#define _POSIX_C_SOURCE 200809L

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct drop {
    Display *display;
    Window source, target;
    Atom selection, uri_list;
    char text[1100];
} drop;

static Atom atom(const drop *d, const char *name)
{
    return XInternAtom(d->display, name, False);
}

static void send(const drop *d, const char *type, long a, long b, long c, long e)
{
    XEvent event;
    memset(&event, 0, sizeof event);
    event.xclient.type = ClientMessage;
    event.xclient.window = d->target;
    event.xclient.message_type = atom(d, type);
    event.xclient.format = 32;
    event.xclient.data.l[0] = (long)d->source;
    event.xclient.data.l[1] = a;
    event.xclient.data.l[2] = b;
    event.xclient.data.l[3] = c;
    event.xclient.data.l[4] = e;
    XSendEvent(d->display, d->target, False, NoEventMask, &event);
    XFlush(d->display);
}

/* The window asks for what was dropped. */
static void answer(const drop *d, const XSelectionRequestEvent *request)
{
    XEvent event;
    XChangeProperty(d->display, request->requestor, request->property, d->uri_list, 8, PropModeReplace,
                    (const unsigned char *)d->text, (int)strlen(d->text));
    memset(&event, 0, sizeof event);
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = request->requestor;
    event.xselection.selection = request->selection;
    event.xselection.target = request->target;
    event.xselection.property = request->property;
    event.xselection.time = request->time;
    XSendEvent(d->display, request->requestor, False, NoEventMask, &event);
    XFlush(d->display);
}

/* Wait for a message of that type. */
static XClientMessageEvent wait_for(const drop *d, const char *type)
{
    for (;;) {
        XEvent event;
        XNextEvent(d->display, &event);
        if (event.type == SelectionRequest) {
            answer(d, &event.xselectionrequest);
        } else if (event.type == ClientMessage && event.xclient.message_type == atom(d, type)) {
            return event.xclient;
        }
    }
}

int main(int argc, char **argv)
{
    drop d;
    if (argc != 3 || strlen(argv[2]) > 1024) {
        return 2;
    }
    alarm(1200); /* the window may never answer; before it does, it converts the file */
    d.display = XOpenDisplay(NULL);
    if (!d.display) {
        return 1;
    }
    d.target = (Window)strtoul(argv[1], NULL, 10);
    d.source = XCreateSimpleWindow(d.display, DefaultRootWindow(d.display), 0, 0, 1, 1, 0, 0, 0);
    d.selection = atom(&d, "XdndSelection");
    d.uri_list = atom(&d, "text/uri-list");
    snprintf(d.text, sizeof d.text, "file://%s\r\n", argv[2]);
    XSetSelectionOwner(d.display, d.selection, d.source, CurrentTime);
    send(&d, "XdndEnter", 5L << 24, (long)d.uri_list, 0, 0);
    send(&d, "XdndPosition", 0, (600L << 16) | 300L, CurrentTime, (long)atom(&d, "XdndActionCopy"));
    if (!(wait_for(&d, "XdndStatus").data.l[1] & 1)) {
        return 1;
    }
    send(&d, "XdndDrop", 0, CurrentTime, 0, 0);
    return wait_for(&d, "XdndFinished").data.l[1] ? 0 : 1; /* bit 0: accepted; GLFW sets others too */
}
