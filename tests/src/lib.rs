//! Plants that several tests share.

pub mod plants;
