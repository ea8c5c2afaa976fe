//! The citation of a dataset.

use cosfly_schema::config::DatasetConfig;

/// The BibTeX entry: the configured one, or one made from title, creator and year.
pub fn citation(config: &DatasetConfig) -> String {
    if !config.citation.is_empty() {
        return config.citation.clone();
    }
    let year = config.date_published.split('-').next().unwrap_or_default();
    format!(
        "@misc{{{},\n  title = {{{}}},\n  author = {{{}}},\n  year = {{{year}}},\n  version = {{{}}},\n  url = {{{}}}\n}}",
        config.name, config.title, config.creator.name, config.version, config.url
    )
}
