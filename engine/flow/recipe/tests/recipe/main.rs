//! Recipes of toy stages through the whole reader: what is checked, what is said, what is generated.

mod checked_recipes;
mod garbage;
mod generated;
mod graph_mistakes;
mod overrides_mistakes;
mod parameters_mistakes;
mod text_mistakes;
mod toys;
