//! The bench and the command line: scenes, runs, verdicts, advice, errors for people, and the walls of the house.

mod advise;
mod closed_loop;
mod commission;
mod docs_book;
mod docs_examples;
mod export;
mod fmu;
mod init;
mod instruments_and_events;
mod judged;
mod layering;
mod licences;
mod machine_scenes;
mod own_controllers;
mod release;
mod report_page;
mod requirements;
mod review;
mod review_findings;
mod review_ledger;
mod review_planes;
mod run;
mod scene_keys;
mod sweep;
mod terminal;
mod verify;
