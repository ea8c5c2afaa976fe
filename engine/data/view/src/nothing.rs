//! [`NothingSubject`]: a folder without flights, shown as words.

use crate::subject::{Index, ViewSubject, ViewedPicture, unknown};
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_secrets::without_secrets;
use serde_json::{Value, json};

/// A dataset that has no flights, or not yet: the page tells why.
pub struct NothingSubject {
    name: String,
    words: Vec<String>,
}

impl NothingSubject {
    /// Subject `name`, which cannot be shown because of `refusal`.
    pub fn new(name: String, refusal: &Diagnostic) -> Self {
        let words = [&refusal.message].into_iter().chain(&refusal.causes).chain(&refusal.hints);
        Self { name, words: words.map(|text| without_secrets(text)).collect() }
    }
}

impl ViewSubject for NothingSubject {
    fn about(&self) -> Result<Value> {
        Ok(json!({
            "name": self.name, "kind": "dataset", "version": "", "flights": 0, "shown": 0, "rejected": 0, "reasons": self.words,
        }))
    }

    fn index(&self) -> Result<Index> {
        Ok(Index::default())
    }

    fn flight(&self, _: usize) -> Result<Value> {
        Err(unknown("flight"))
    }

    fn bodies(&self, _: usize) -> Result<Value> {
        Err(unknown("flight"))
    }

    fn town(&self, _: usize) -> Result<Value> {
        Err(unknown("flight"))
    }

    fn paths(&self, _: usize) -> Result<Value> {
        Err(unknown("flight"))
    }

    fn picture(&self, _: usize, _: usize, _: &str) -> Result<ViewedPicture> {
        Err(unknown("flight"))
    }
}
