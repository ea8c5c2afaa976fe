//! No code: the manifest beside this folder asks for features of other people's crates, so that they are built once.
