//! Recipes of toy stages through the whole reader: checks, messages, generated texts.

mod checked_recipes;
mod file_mistakes;
mod for_each;
mod garbage;
mod generated;
mod graph_mistakes;
mod item_mistakes;
mod list_mistakes;
mod optional_parts;
mod overrides_mistakes;
mod parameters_mistakes;
mod text_mistakes;
mod toy_configs;
mod toys;
mod value_mistakes;
