//! Messages to the user: `warn` and `error` come with the item's warnings; the others with `cosfly plugin check` only.

#[cfg(target_family = "wasm")]
#[link(wasm_import_module = "cosfly:plugin/log@0.1.0")]
unsafe extern "C" {
    safe fn message(level: usize, text: *const u8, bytes: usize);
}

fn say(level: usize, text: &str) {
    #[cfg(target_family = "wasm")]
    message(level, text.as_ptr(), text.len());
    #[cfg(not(target_family = "wasm"))]
    eprintln!("{}: {text}", ["debug", "info", "warn", "error"][level]);
}

/// For authors, in detail.
pub fn debug(text: &str) {
    say(0, text);
}

/// For authors.
pub fn info(text: &str) {
    say(1, text);
}

/// For users: something to know about.
pub fn warn(text: &str) {
    say(2, text);
}

/// For users: why it goes no further.
pub fn error(text: &str) {
    say(3, text);
}

/// Makes panics messages, once.
#[doc(hidden)]
pub fn panics_as_messages() {
    #[cfg(target_family = "wasm")]
    {
        static ONCE: std::sync::Once = std::sync::Once::new();
        ONCE.call_once(|| std::panic::set_hook(Box::new(|info| error(&info.to_string().replace('\n', " ")))));
    }
}
