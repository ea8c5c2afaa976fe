//! The citation of a dataset.

use cosfly_diagnose::visible_text;
use cosfly_schema::config::DatasetConfig;

/// Text as it stands between the braces of a BibTeX entry: in one line, with round brackets, because BibTeX counts braces.
fn in_braces(text: &str) -> String {
    visible_text(text).replace('\n', " ").replace('{', "(").replace('}', ")")
}

/// The BibTeX entry: the configured one, or one made from title, creator and year.
pub fn citation(config: &DatasetConfig) -> String {
    if !config.citation.is_empty() {
        return config.citation.clone();
    }
    let year = config.date_published.split('-').next().unwrap_or_default();
    format!(
        "@misc{{{},\n  title = {{{}}},\n  author = {{{}}},\n  year = {{{year}}},\n  version = {{{}}},\n  url = {{{}}}\n}}",
        config.name,
        in_braces(&config.title),
        in_braces(&config.creator.name),
        config.version,
        in_braces(&config.url)
    )
}
