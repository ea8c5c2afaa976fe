//! Messages to the user: `warn` and `error` come with the item's warnings; the others with `cosfly plugin check` only.

macro_rules! level {
    ($(#[$doc:meta])* $name:ident, $level:ident) => {
        $(#[$doc])*
        pub fn $name(text: &str) {
            #[cfg(target_family = "wasm")]
            crate::bindings::cost_term::cosfly::plugin::log::message(crate::bindings::cost_term::cosfly::plugin::log::Level::$level, text);
            #[cfg(not(target_family = "wasm"))]
            eprintln!("{}: {text}", stringify!($name));
        }
    };
}

level!(
    /// For authors, in detail.
    debug,
    Debug
);
level!(
    /// For authors.
    info,
    Info
);
level!(
    /// For users: something to know about.
    warn,
    Warn
);
level!(
    /// For users: why it goes no further.
    error,
    Error
);

/// Makes panics messages, once.
#[doc(hidden)]
pub fn panics_as_messages() {
    #[cfg(target_family = "wasm")]
    {
        static ONCE: std::sync::Once = std::sync::Once::new();
        ONCE.call_once(|| std::panic::set_hook(Box::new(|info| error(&info.to_string().replace('\n', " ")))));
    }
}
