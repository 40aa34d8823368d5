/* fluidy-window ADDRESS: a page in a window of its own, until the window is closed. */
#include <stdio.h>
#include <webkit2/webkit2.h>

static void on_title(GObject *view, GParamSpec *spec, void *window)
{
    const char *title = webkit_web_view_get_title(WEBKIT_WEB_VIEW(view));
    gtk_window_set_title(window, title && *title ? title : "fluidy-svg");
}

/* A download is saved in a file that the user chooses. */
static gboolean on_destination(WebKitDownload *download, const char *name, void *window)
{
    g_autoptr(GtkFileChooserNative) chooser = gtk_file_chooser_native_new(
        "Save the config", window, GTK_FILE_CHOOSER_ACTION_SAVE, NULL, NULL);
    gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(chooser), name);
    gtk_file_chooser_set_do_overwrite_confirmation(GTK_FILE_CHOOSER(chooser), TRUE);
    if (gtk_native_dialog_run(GTK_NATIVE_DIALOG(chooser)) != GTK_RESPONSE_ACCEPT) {
        webkit_download_cancel(download);
        return TRUE;
    }
    g_autofree char *uri = gtk_file_chooser_get_uri(GTK_FILE_CHOOSER(chooser));
    webkit_download_set_allow_overwrite(download, TRUE);
    webkit_download_set_destination(download, uri);
    return TRUE;
}

static void on_download(WebKitWebContext *context, WebKitDownload *download, void *window)
{
    g_signal_connect(download, "decide-destination", G_CALLBACK(on_destination), window);
}

int main(int argc, char **argv)
{
    if (!gtk_init_check(&argc, &argv) || argc != 2) {
        fputs(argc == 2 ? "fluidy-window: there is no display\n" : "usage: fluidy-window ADDRESS\n",
              stderr);
        return 1;
    }
    GtkWidget *window = gtk_window_new(GTK_WINDOW_TOPLEVEL);
    GtkWidget *view = webkit_web_view_new();
    gtk_window_set_default_size(GTK_WINDOW(window), 1280, 860);
    gtk_container_add(GTK_CONTAINER(window), view);
    g_signal_connect(window, "destroy", G_CALLBACK(gtk_main_quit), NULL);
    g_signal_connect(view, "notify::title", G_CALLBACK(on_title), window);
    g_signal_connect(webkit_web_context_get_default(), "download-started", G_CALLBACK(on_download),
                     window);
    webkit_web_view_load_uri(WEBKIT_WEB_VIEW(view), argv[1]);
    gtk_widget_show_all(window);
    gtk_main();
    return 0;
}
