//! The shell of a page: head with the style, heading, contents, sections, foot. No script, nothing is loaded.

use cosfly_plot::text::escaped;
use std::fmt::Write;

const STYLE: &str = include_str!("../assets/style.css");

/// A section of a page.
pub struct Section<'a> {
    /// Anchor.
    pub id: &'a str,
    /// Title in the contents.
    pub short_title: &'a str,
    /// Title.
    pub title: &'a str,
    /// Content, HTML; a section without content is left out.
    pub body: String,
}

/// The page; `heading` and `foot` are HTML.
pub fn document(title: &str, heading: &str, sections: &[Section<'_>], foot: &str) -> String {
    let shown: Vec<&Section<'_>> = sections.iter().filter(|section| !section.body.is_empty()).collect();
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<link rel=\"icon\" href=\"data:,\">\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#main\">Skip to the content</a>\n",
        title = escaped(title)
    );
    html.push_str(heading);
    html.push_str("<nav aria-label=\"Contents\"><ul>");
    for Section { id, short_title, .. } in &shown {
        let _ = write!(html, "<li><a href=\"#{id}\">{short_title}</a></li>");
    }
    html.push_str("</ul></nav>\n<main id=\"main\">\n");
    for Section { id, title, body, .. } in &shown {
        let _ = writeln!(
            html,
            "<section id=\"{id}\" aria-labelledby=\"{id}-title\"><h2 id=\"{id}-title\">{title}</h2>{body}</section>"
        );
    }
    html.push_str("</main>\n");
    html.push_str(foot);
    html.push_str("</body>\n</html>\n");
    html
}
