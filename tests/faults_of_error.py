"""Faults of `--error`."""
from fault import Fault, tolerance


def refinement(name, file, old, new, cases):
    return Fault(name, f"kernel/picture/{file}", old, new, "picture", cases)


def adaptive(name, constant, value, planted, cases):
    return tolerance(name, "picture/tolerances.hpp", constant, value, planted, "picture", cases)


FAULTS = [
    Fault("no samples in boxes", "kernel/shade/strip.hpp", "if (work.boxes)", "if (false)",
          "shade", "*PixelBoxes.GetHalf*"),
    Fault("samples in boxes that weigh as all", "kernel/shade/strip.hpp",
          "return select(has, two * select(aimed, area, rest), one);", "return one;", "shade",
          "*PixelBoxes.Move*"),
    Fault("no box pays", "kernel/shade/pixel_box.hpp", "kLargestBox = .25f;", "kLargestBox = 0;",
          "picture", "SmallObjects.FindSpecks"),
    adaptive("no disc", "kDiscInBox", ".7853982f", "0", "SmallObjects.FindSpecks"),
    adaptive("one difference too few of the young", "kYoung", "3", "2", "*.EstimateThe*"),
    adaptive("one difference too few of the old", "kOld", "7", "6", "*.EstimateThe*"),
    adaptive("none agree", "kAgreement", ".005f", "0", "*SeeASample*"),
    adaptive("too many agree", "kAgreement", ".005f", ".02f", "*SeeASample*"),
    adaptive("every block for itself", "kEnoughHits", "16", "0", "*.PoolRareHits"),
    adaptive("any blocks alike", "kAlike", "3", "300", "*.LendNothing*"),
    adaptive("no blocks alike", "kAlike", "3", "0", "*.PoolRareHits"),
    adaptive("edges that lend", "kMinHits", "3", "30", "*.LendNothing*"),
    adaptive("checks of any weight", "kMaxErrorRatio", "16", "1e9", "*WithinReason*"),
    refinement("claims that no check corrects", "block_errors.cpp",
               "const double ratio = r_.checked.ratio();", "const double ratio = 1;",
               "Checks.CorrectWhat*"),
    refinement("blocks that agree and are right", "block_errors.cpp",
               "static_cast<float>(r_.checked.by_sample()) / samples", "0.f",
               "Checks.SeeThrough*"),
    refinement("sums of earlier samples", "block_errors.cpp", "if (version_[b] != r_.log[b])",
               "if (version_[b] == 0)", "*.FollowThePicture"),
    refinement("white that is told from differences", "block_errors.cpp", "if (mean > 1) {",
               "if (false) {", "*BeyondWhite*"),
    refinement("blocks that can have no more", "block_errors.cpp", "r_.log[b] < kMostLog ?",
               "true ?", "*.AddWhatIsFound*"),
    refinement("the same blocks checked again", "round_plan.cpp",
               "seed + static_cast<std::uint32_t>(r.checks)", "seed", "Checks.DrawAsMany*"),
    refinement("checks as long for any error", "round_plan.cpp", "enough * claim * claim",
               "enough", "Checks.DrawAsMany*"),
    refinement("checks that find nothing", "round_plan.cpp",
               "1 / (1 - (agreed ? .5 : static_cast<double>(r.variance_ratio)))", "0.",
               "Checks.SeeThrough*"),
    refinement("rounds without a cut", "round_plan.cpp",
               "cut.limit = is_cut ? cut.limit : Limit::kError;", "", "RoundPlan.IsTheSame*"),
    refinement("nothing kept before limits", "round_plan.cpp", "if (asked.refinable)",
               "if (false)", "Refinement.AFinerError*"),
    refinement("caps that do not hold", "round_plan.cpp", "if (r.log[b] + k < most)", "if (true)",
               "Refinement.EndsAtThe*"),
    refinement("boxes of all that is thin", "small_objects.cpp", "if (bright_[p] < 0)",
               "if (false)", "SmallObjects.ShareABox*"),
    refinement("one box to each rod", "small_objects.cpp", "kMostParts = 256;", "kMostParts = 1;",
               "SmallObjects.FollowLong*"),
    refinement("boxes of what is out of focus", "small_objects.cpp", "kMostBlur = .25f;",
               "kMostBlur = 1e9f;", "SmallObjects.LeaveWhat*"),
    refinement("boxes of every triangle", "small_objects.cpp", "kMostUses = 2;",
               "kMostUses = 200;", "SmallObjects.MayBeMeshes"),
    refinement("mirrors that show what is behind", "small_objects.cpp",
               "if (mirror.above(capsule.end[0]) * mirror.above(eye) <= 0)", "if (false)",
               "SmallObjects.ShowInFlatMirrors"),
]
