//! The budget: every request is booked before it is sent, at the most that it can cost, and corrected by what it did cost.

use crate::config::{BudgetConfig, TeacherConfig};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_fingerprint::Digest;
use cosfly_stage::{Answers, Spent};

/// Code of the refusal of a request beyond the budget.
pub const SPENT: &str = "teacher-budget";

/// Account of a model.
pub fn account_of(config: &TeacherConfig) -> Digest {
    Digest::of(format!("cosfly.teacher-account/1\n{}", config.model).as_bytes())
}

/// A request that was booked.
#[derive(Debug)]
pub struct Booking {
    input_tokens: u64,
    output_tokens: u64,
}

/// Books a request of estimated size.
///
/// # Errors
/// [`SPENT`] where it might not fit, and errors of the account.
pub fn book(config: &TeacherConfig, answers: &dyn Answers, input_tokens: u64) -> Result<Booking> {
    let booking = Booking { input_tokens, output_tokens: u64::from(config.max_tokens) };
    answers.account(&account_of(config), &mut |spent| {
        let next = Spent {
            calls: spent.calls.saturating_add(1),
            input_tokens: spent.input_tokens.saturating_add(booking.input_tokens),
            output_tokens: spent.output_tokens.saturating_add(booking.output_tokens),
        };
        check(&config.budget, &next, spent)?;
        *spent = next;
        Ok(())
    })?;
    Ok(booking)
}

/// Corrects a booking by the real tokens; none where no answer came.
pub fn settle(config: &TeacherConfig, answers: &dyn Answers, booking: &Booking, tokens: [u64; 2]) -> Result<()> {
    answers.account(&account_of(config), &mut |spent| {
        let corrected = |spent: u64, booked: u64, real: u64| spent.saturating_sub(booked).saturating_add(real);
        spent.input_tokens = corrected(spent.input_tokens, booking.input_tokens, tokens[0]);
        spent.output_tokens = corrected(spent.output_tokens, booking.output_tokens, tokens[1]);
        Ok(())
    })
}

fn check(budget: &BudgetConfig, next: &Spent, spent: &Spent) -> Result<()> {
    let money = |spent: &Spent| {
        (spent.input_tokens as f64 * budget.input_price + spent.output_tokens as f64 * budget.output_price) / 1e6
    };
    let tokens = |spent: &Spent| spent.input_tokens.saturating_add(spent.output_tokens);
    let limit = if budget.calls > 0 && next.calls > budget.calls {
        format!("`budget.calls` is {}", budget.calls)
    } else if budget.tokens > 0 && tokens(next) > budget.tokens {
        format!("`budget.tokens` is {}", budget.tokens)
    } else if budget.money > 0.0 && money(next) > budget.money {
        format!("`budget.money` is {}", budget.money)
    } else {
        return Ok(());
    };
    let (calls, tokens, money) = (spent.calls, tokens(spent), money(spent));
    let message = format!(
        "{limit}, and one more request might exceed it: {calls}, {tokens} tokens, {money:.4} spent",
        calls = counted(calls, "request")
    );
    Err(Diagnostic::new("teacher-budget", Fault::Recipe, message)
        .hint("raise the budget and run the same command again: kept answers are not asked for again; or set `budget.when_spent = \"template\"`"))
}
