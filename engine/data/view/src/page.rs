//! The files of the page.

/// A file of the page.
pub struct Asset {
    /// Path at which it is served.
    pub path: &'static str,
    /// Media type.
    pub media_type: &'static str,
    /// Content.
    pub text: &'static str,
}

const SCRIPT: &str = "text/javascript; charset=utf-8";

/// The page itself.
pub const PAGE: Asset =
    Asset { path: "/", media_type: "text/html; charset=utf-8", text: include_str!("../assets/index.html") };

/// Its style.
pub const STYLE: Asset =
    Asset { path: "/style.css", media_type: "text/css; charset=utf-8", text: include_str!("../assets/style.css") };

/// Its scripts, in the order in which they run.
pub const SCRIPTS: [Asset; 7] = [
    Asset { path: "/source.js", media_type: SCRIPT, text: include_str!("../assets/source.js") },
    Asset { path: "/filter.js", media_type: SCRIPT, text: include_str!("../assets/filter.js") },
    Asset { path: "/list.js", media_type: SCRIPT, text: include_str!("../assets/list.js") },
    Asset { path: "/map.js", media_type: SCRIPT, text: include_str!("../assets/map.js") },
    Asset { path: "/scene.js", media_type: SCRIPT, text: include_str!("../assets/scene.js") },
    Asset { path: "/pictures.js", media_type: SCRIPT, text: include_str!("../assets/pictures.js") },
    Asset { path: "/main.js", media_type: SCRIPT, text: include_str!("../assets/main.js") },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_names_its_files_in_their_order_and_loads_nothing_else() {
        let places: Vec<Option<usize>> =
            SCRIPTS.iter().map(|script| PAGE.text.find(&format!("<script src=\"{}\"", &script.path[1..]))).collect();
        assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}");
        assert!(PAGE.text.contains("<link rel=\"stylesheet\" href=\"style.css\">"));
        for text in SCRIPTS.iter().map(|script| script.text).chain([PAGE.text, STYLE.text]) {
            for word in
                ["http:", "https:", "innerHTML", "outerHTML", "insertAdjacentHTML", "eval(", " style=", " onclick="]
            {
                assert!(!text.contains(word), "the page has `{word}`");
            }
        }
    }
}
