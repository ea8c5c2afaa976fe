//! Plan, schedule, execute, resume, explain.
