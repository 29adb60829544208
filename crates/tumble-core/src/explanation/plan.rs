//! T02xx: what the plan of angles and runs cannot tell.

use super::Explanation;
use crate::Targets;
use crate::assess::REPEAT_LIMIT;
use crate::judge::limits::{CONDITION_WARNING, FEW};
use crate::stats::student_factor;

const IDENTIFIABILITY: &str = "method, section 7 (identifiability)";
const REPRODUCIBILITY: &str = "method, section 9 (several runs)";

pub(super) fn rank_deficient() -> Explanation {
    Explanation::new(
        "The run has fewer different angles than unknowns, or none on the table at all, so at least one of bias, \
         misalignment and scale error is not determined. The finding names those that are missing.",
        "Three unknowns want three well separated angles. What the angles do give is written as evidence; the rest \
         would be a guess.",
        "Add dwells on the table on both sides of 0°, for instance at -60°, 0° and 60°, each several times, in the same \
         mounting and power-up.",
        IDENTIFIABILITY,
    )
}

pub(super) fn no_redundancy() -> Explanation {
    Explanation::new(
        "There are as many positions as unknowns. The curve goes through every point, and nothing is left over to show \
         how good the points are.",
        "The values may be right, but their uncertainty cannot be estimated. A value without uncertainty is no \
         calibration.",
        "Measure every angle at least twice, or add angles: 12 serve, 60 are good.",
        IDENTIFIABILITY,
    )
}

pub(super) fn no_lack_of_fit_test() -> Explanation {
    Explanation::new(
        "There are repeats, but no more different angles than unknowns. The repeats show the scatter; nothing can show \
         whether the model fits between the angles.",
        "A curved sensor, an eccentric dial or a wrong angle would go straight into the values, and the repeats would \
         agree all the same.",
        "Add one or two spare angles in between, for instance -30° and 30° where -60°, 0° and 60° were measured.",
        "method, sections 7 and 11 (spare angles for the lack-of-fit test)",
    )
}

pub(super) fn undetermined() -> Explanation {
    let t = Targets::default();
    Explanation::new(
        format!(
            "The expanded uncertainty of a value exceeds its target. Without targets of your own these are {} m/s², {} \
             mrad and {} % for bias, misalignment and scale error.",
            t.bias_m_s2,
            t.misalignment_rad * 1e3,
            t.scale_error * 100.0
        ),
        "The plan or the scatter leaves the value too vague to use. Over a narrow range bias and misalignment do the \
         same to the readings: -30° to 29° knows the bias to 0.62 LSB where the best plan of the same length knows it to \
         0.064 (0.2 LSB of scatter, 60 positions).",
        "Do what the finding says: mostly use the table's whole range, or add a dwell each with the axis up and down in \
         the same power-up. If less serves you, write your own target in [spec], for instance `target_bias_m_s2 = 0.1`.",
        "method, section 7; docs/decisions/0004-default-targets.md",
    )
}

pub(super) fn ill_conditioned() -> Explanation {
    Explanation::new(
        format!(
            "Over the angles of this run two unknowns change the readings almost alike. It is said from a condition \
             number of {CONDITION_WARNING:.0} on (a measure of how alike); good plans have 5 to 11. It explains an \
             uncertainty and decides nothing."
        ),
        "The sum of the two is known well and each alone badly. The paper's plan (-30° to 29°, condition number 48) \
         knows the bias ten times worse than the best plan of the same length: 0.616 LSB against 0.064.",
        "Next time put dwells near both ends of the table's range and not only in the middle. Or add one dwell with the \
         axis up and one with it down in the same power-up, and name that run in [scale]: `run = \"run-1\"`. The result \
         at hand stands.",
        IDENTIFIABILITY,
    )
}

pub(super) fn one_run() -> Explanation {
    Explanation::new(
        "There is one run, so one power-up.",
        "The bias of an accelerometer changes from power-up to power-up, often by more than a run's own uncertainty. \
         One run cannot show that: its numbers hold for this power-up only.",
        "Switch the sensor off, let it rest, switch it on, and repeat the run: [[run]] with `file = \"run-2.csv\"`. Two \
         runs lift this finding, five are good.",
        REPRODUCIBILITY,
    )
}

pub(super) fn no_runs() -> Explanation {
    Explanation::new(
        "experiment.toml has dwells with the axis up and down ([scale]) and no [[run]] on the table.",
        "Up and down give the scale and, roughly, the bias. They give no misalignment, and two points lie on any line: \
         nothing shows that the model fits.",
        "Measure a run of dwells at several angles on the table and name its file: [[run]] with `file = \"run-1.csv\"`. \
         -60° to 60° in twelve or more steps serve.",
        IDENTIFIABILITY,
    )
}

pub(super) fn empty_intersection() -> Explanation {
    Explanation::new(
        "Each run has an interval for this value, and no single number lies in all of them.",
        "The runs differ by more than their own uncertainties: the unit changes between power-ups or mountings. The \
         result holds that spread already. With a spread as large as a run's own uncertainty, 28 of 100 honest series of \
         five runs look like this.",
        "To find the cause, compare temperature, warm-up and mounting of the runs. If each run was mounted anew, give \
         each its own `mounting = \"B\"`. Otherwise nothing: use the interval for the next power-up.",
        REPRODUCIBILITY,
    )
}

pub(super) fn few_runs() -> Explanation {
    let t = |runs: u32| {
        student_factor(0.95, f64::from(runs - 1)).map_or_else(String::new, |t| format!("{t:.1}"))
    };
    Explanation::new(
        format!("There are fewer than {FEW} runs."),
        format!(
            "The spread of so few values is itself badly known, and the interval pays for that: at 95 % the factor on \
             the standard uncertainty is {} with two runs, {} with three and {} with five.",
            t(2),
            t(3),
            t(5)
        ),
        "If the interval is too wide for you, measure more runs, each with its own power-up. Two more help more than \
         anything else.",
        REPRODUCIBILITY,
    )
}

pub(super) fn runs_too_few() -> Explanation {
    Explanation::new(
        "Every run alone reaches the target for this value, the runs together do not: the spread between them is large, \
         or known from too few of them.",
        "More positions would not help. What is vague is how far the unit repeats from power-up to power-up.",
        "Measure more runs, each with a power-up of its own; from two to five the factor on the uncertainty falls from \
         12.7 to 2.8. Or write a wider target in [spec].",
        "method, section 9; docs/decisions/0004-default-targets.md",
    )
}

pub(super) fn errors_repeat() -> Explanation {
    Explanation::new(
        format!(
            "The residuals at the same angles are alike in all runs: their mean correlation is more than {REPEAT_LIMIT} \
             times what chance makes of it (one false alarm in two thousand)."
        ),
        "Errors of the dial's divisions, or steps of a converter with too little noise, come back in every run. The \
         runs then agree better than they are right; that part is kept in the uncertainty of the mean and more runs do \
         not reduce it.",
        "In the next run measure other angles, for instance half a step on. If the converter shows one code a dwell, add \
         noise (more bandwidth) or use `--method likelihood`.",
        "method, sections 8 and 9",
    )
}
