// The refined model: its sums against plain linear algebra, its steps against finite differences,
// and what it recovers of a model that made the data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>

#include "dam/kinds/refined/curves_fit.h"
#include "dam/kinds/refined/dominance.h"
#include "dam/kinds/refined/fit.h"
#include "dam/kinds/refined/terms.h"
#include "dam/maths/linear_algebra.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/train.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace refined_test {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST(Cholesky, TiledFactorsSolveForAnyThreads) {
  test::Uniform random(3);
  for (const int n : {1, 7, 192, 193, 450}) {
    Eigen::MatrixXd a(n, n);
    for (Eigen::Index i = 0; i < a.size(); ++i) a.data()[i] = random(-1, 1);
    a = (a * a.transpose()).eval();
    a.diagonal().array() += 0.5;
    RowMatrix b(n, 3);
    for (Eigen::Index i = 0; i < b.size(); ++i) b.data()[i] = random(-1, 1);
    std::vector<double> one(a.data(), a.data() + a.size()), three = one;
    ASSERT_TRUE(cholesky_in_place(one, std::size_t(n), 1));
    ASSERT_TRUE(cholesky_in_place(three, std::size_t(n), 3));
    EXPECT_EQ(one, three);
    std::vector<double> x(b.data(), b.data() + b.size());
    cholesky_solve(one, std::size_t(n), x, 3, 2);
    const RowMatrix want = a.llt().solve(b);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], want.data()[i], 1e-8);
  }
  std::vector<double> bad = {1, 2, 2, 1};
  EXPECT_FALSE(cholesky_in_place(bad, 2, 1));
}

/// Uniform sentences of five phones with everything a fit needs.
struct Problem {
  std::vector<PhoneModel> phones;
  SpeechData speech;
  RefinedData data;

  Problem(test::Uniform& random, std::size_t controls, std::size_t sentences = 3) {
    const std::uint32_t classes[] = {0, 1, 8, 10, 1};
    for (std::uint32_t p = 0; p < 5; ++p)
      phones.push_back({std::string(1, char('A' + p)), 10, classes[p], random(0.06, 0.12), 1});
    speech.controls = controls;
    speech.rate = 50;
    for (std::size_t s = 0; s < sentences; ++s) add_sentence(random);
    for (std::size_t i = 0; i < speech.use.size() * controls; ++i)
      speech.target.push_back(random(-1, 1));
    data.speech = &speech;
    data.phones = phones;
    data.controls = data.prior_controls = controls;
    data.target = speech.target;
    data.around = neighbourhoods(speech, phones);
  }

  void add_sentence(test::Uniform& random) {
    FitSentence sentence{speech.use.size(), 60, speech.occurrences.size(), 9};
    double t = 0.1;
    for (std::size_t j = 0; j < 9; ++j) {
      const double duration = random(0.05, 0.18);
      speech.occurrences.push_back(
          {t, duration, std::int32_t(random.below(5)), kRestContext, kRestContext, 0});
      t += duration;
    }
    for (std::size_t j = 0; j < 9; ++j) {
      auto* o = &speech.occurrences[sentence.first_occurrence + j];
      if (j > 0) o->left = (o - 1)->phone;
      if (j < 8) o->right = (o + 1)->phone;
    }
    for (std::size_t i = 0; i < sentence.frames; ++i) speech.use.push_back(random(0, 1) > 0.1);
    speech.sentences.push_back(sentence);
  }
};

std::vector<PhoneDominance> random_dominance(test::Uniform& random, std::size_t phones) {
  std::vector<PhoneDominance> list;
  for (std::size_t p = 0; p < phones; ++p)
    list.push_back({random(0.05, 0.12), random(0.05, 0.12), random(0.5, 2)});
  return list;
}

/// The whole design, one row a used frame, and one more column per sentence for its offset.
struct Dense {
  Eigen::MatrixXd x;
  RowMatrix y;
  Eigen::VectorXd ridge;
};

Dense dense_problem(const Problem& problem, const TermSpace& space,
                    std::span<const PhoneDominance> dominance) {
  const RefinedData& data = problem.data;
  Eigen::Index frames = 0;
  for (const auto use : problem.speech.use) frames += use;
  const auto sentences = Eigen::Index(problem.speech.sentences.size());
  const auto n = Eigen::Index(space.size), k = Eigen::Index(data.controls);
  Dense dense{Eigen::MatrixXd::Zero(frames, n + sentences), RowMatrix(frames, k),
              Eigen::VectorXd(n + sentences)};
  Eigen::Index row = 0;
  for (Eigen::Index s = 0; s < sentences; ++s) {
    const FitSentence& sentence = problem.speech.sentences[std::size_t(s)];
    const RefinedDesign design = make_refined_design(data, sentence, dominance);
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      const std::size_t frame = sentence.first_frame + i;
      if (problem.speech.use[frame] == 0) continue;
      for (const RefinedPart& part : design.frame(i)) {
        const auto uses = terms_of(data.phones, data.around[part.occurrence]);
        for (std::size_t t = 0; t < kTermCount; ++t)
          for (std::size_t m = 0; space.holds(t, uses[t]) && m < kTermInfo[t].orders; ++m)
            dense.x(row, Eigen::Index(space.at(t, uses[t].key) + m)) +=
                uses[t].scale * part.weight * part.basis[m];
      }
      dense.x(row, n + s) = 1;
      for (Eigen::Index c = 0; c < k; ++c)
        dense.y(row, c) = data.target[frame * data.controls + std::size_t(c)];
      ++row;
    }
  }
  const auto ridge = ridge_of(space, own_columns(space), 1);
  for (Eigen::Index i = 0; i < n; ++i) dense.ridge[i] = ridge[std::size_t(i)];
  dense.ridge.tail(sentences).setConstant(data.offset_frames);
  return dense;
}

TEST(RefinedCurves, SumsAreThoseOfTheWholeDesignWithOffsets) {
  test::Uniform random(11);
  const Problem problem(random, 2);
  const auto dominance = random_dominance(random, 5);
  const TermSpace space = term_space(problem.data);
  const std::vector<float> all(problem.speech.use.begin(), problem.speech.use.end());
  const CurveSums sums = sum_curves(problem.data, space, dominance, all);
  const TermColumns columns = own_columns(space);
  const auto curves = solve_curves(sums.gram, sums.right, space, columns, 2, 1, 1);
  EXPECT_EQ(curves_of(space, columns, curves, 2), curves);

  const Dense dense = dense_problem(problem, space, dominance);
  Eigen::MatrixXd gram = dense.x.transpose() * dense.x;
  gram.diagonal() += dense.ridge;
  const RowMatrix want = gram.ldlt().solve(dense.x.transpose() * dense.y);
  for (std::size_t i = 0; i < curves.size(); ++i) EXPECT_NEAR(curves[i], want.data()[i], 1e-7);

  // The error on the summed sentences is that of the best offsets.
  double error = 0;
  const RowMatrix residual = dense.y - dense.x * want;
  error = residual.squaredNorm();
  for (Eigen::Index s = Eigen::Index(space.size); s < want.rows(); ++s)
    error += problem.data.offset_frames * want.row(s).squaredNorm();
  const auto errors = errors_of(sums, curves, 2).error;
  EXPECT_NEAR(errors[0] + errors[1], error, 1e-6 * error);
}

TEST(RefinedCurves, EqualUnknownsAreSolvedAsOneAndSharedOut) {
  test::Uniform random(13);
  Problem problem(random, 3, 2);
  const auto dominance = random_dominance(random, 5);
  const TermSpace space = term_space(problem.data);
  const std::vector<float> all(problem.speech.use.begin(), problem.speech.use.end());
  const TermColumns own = own_columns(space), shared = shared_columns(problem.data, space);
  EXPECT_LT(shared.size, space.size * 3 / 4);
  const CurveSums sums = sum_curves(problem.data, space, dominance, all);
  const auto want = solve_curves(sums.gram, sums.right, space, own, 3, 1, 1);
  for (const int threads : {1, 3}) {
    problem.data.threads = threads;
    CurveSums fewer(shared.size, 3);
    add_curves(problem.data, space, shared, dominance, all, fewer);
    const auto solution = solve_curves(fewer.gram, fewer.right, space, shared, 3, 1, threads);
    const auto curves = curves_of(space, shared, solution, 3);
    ASSERT_EQ(curves.size(), want.size());
    for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(curves[i], want[i], 1e-6);
    // Errors by sums, and without them.
    const CurveErrors by_sums = errors_of(fewer, solution, 3);
    const CurveErrors direct = errors_on(problem.data, space, shared, dominance, all, solution);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(direct.error[c], by_sums.error[c], 1e-8 * by_sums.error[c]);
      EXPECT_NEAR(direct.energy[c], by_sums.energy[c], 1e-9 * by_sums.energy[c]);
    }
  }
}

TEST(RefinedCurves, PartsOfACorpusAddUp) {
  test::Uniform random(12);
  const Problem problem(random, 2, 6);
  const auto dominance = random_dominance(random, 5);
  const TermSpace space = term_space(problem.data);
  const auto some = [&](std::size_t a, std::size_t b) {
    std::vector<float> wanted(problem.speech.use.size(), 0.0F);
    for (std::size_t s = a; s < b; ++s) {
      const FitSentence& sentence = problem.speech.sentences[s];
      for (std::size_t i = 0; i < sentence.frames; ++i)
        wanted[sentence.first_frame + i] = float(problem.speech.use[sentence.first_frame + i]);
    }
    return sum_curves(problem.data, space, dominance, wanted);
  };
  CurveSums sum = some(0, 2);
  sum.add(some(2, 6));
  const CurveSums whole = some(0, 6);
  EXPECT_EQ(sum.frames, whole.frames);
  for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(sum.energy[c], whole.energy[c], 1e-9);
  for (std::size_t i = 0; i < whole.right.size(); ++i)
    EXPECT_NEAR(sum.right[i], whole.right[i], 1e-9);
}

/// Objective as a function of one parameter, the curves kept as they are.
double objective_with(const Problem& problem, const DominanceOptions& options, DominanceFit fit,
                      std::size_t parameter, double by) {
  PhoneDominance& d = fit.dominance[parameter / 3];
  double& value = parameter % 3 == 0 ? d.left : parameter % 3 == 1 ? d.right : d.strength;
  value *= std::exp(by);
  double sum = 0;
  const std::size_t k = problem.data.controls;
  for (const FitSentence& sentence : problem.speech.sentences) {
    const RefinedDesign design = make_refined_design(problem.data, sentence, fit.dominance);
    std::vector<double> total(k, 0.0);
    double frames = 0;
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      const std::size_t frame = sentence.first_frame + i;
      if (problem.speech.use[frame] == 0) continue;
      frames += 1;
      for (std::size_t c = 0; c < k; ++c) {
        double r = problem.data.target[frame * k + c];
        for (const RefinedPart& part : design.frame(i))
          for (std::size_t m = 0; m < kRefinedOrders; ++m)
            r -= part.weight * part.basis[m] * fit.base[(part.phone * kRefinedOrders + m) * k + c];
        sum += r * r;
        total[c] += r;
      }
    }
    for (const double r : total) sum -= r * r / (frames + problem.data.offset_frames);
  }
  for (const PhoneDominance& p : fit.dominance)
    sum += options.prior * double(k) *
           (std::pow(std::log(p.left / 0.08), 2) + std::pow(std::log(p.right / 0.08), 2) +
            std::pow(std::log(p.strength), 2));
  return sum;
}

TEST(RefinedDominance, GradientIsThatOfFiniteDifferences) {
  test::Uniform random(21);
  const Problem problem(random, 2);
  DominanceOptions options;
  const DominanceFit fit = start_dominance(problem.data, options, random_dominance(random, 5));
  const DominanceStep step = dominance_step(problem.data, options, fit, false);
  const double h = 1e-5;
  for (std::size_t p = 0; p < step.gradient.size(); ++p) {
    const double up = objective_with(problem, options, fit, p, h);
    const double down = objective_with(problem, options, fit, p, -h);
    // The step works with half the objective; its gradient points downhill.
    EXPECT_NEAR(step.gradient[p], -(up - down) / (4 * h), 1e-4) << "parameter " << p;
  }
}

TEST(RefinedDominance, ProjectionLowersTheMatrixAndItStaysSymmetric) {
  test::Uniform random(22);
  const Problem problem(random, 3);
  DominanceOptions options;
  const DominanceFit fit = start_dominance(problem.data, options, random_dominance(random, 5));
  const DominanceStep plain = dominance_step(problem.data, options, fit, false);
  const DominanceStep projected = dominance_step(problem.data, options, fit, true);
  EXPECT_EQ(plain.gradient, projected.gradient);
  const auto n = Eigen::Index(plain.gradient.size());
  const Eigen::Map<const Eigen::MatrixXd> a(plain.hessian.data(), n, n);
  const Eigen::Map<const Eigen::MatrixXd> b(projected.hessian.data(), n, n);
  EXPECT_LT((a - a.transpose()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((b - b.transpose()).cwiseAbs().maxCoeff(), 1e-8);
  for (Eigen::Index i = 0; i < n; ++i) EXPECT_LE(b(i, i), a(i, i) + 1e-9);
}

TEST(RefinedDominance, ObjectiveNeverRisesAndThreadsDoNotMatter) {
  test::Uniform random(23);
  Problem problem(random, 2, 5);
  DominanceOptions options;
  options.prior = 1;
  const auto run = [&](int threads) {
    problem.data.threads = threads;
    DominanceFit fit = start_dominance(problem.data, options);
    std::vector<double> objective = {fit.objective};
    fit_dominance(problem.data, options, fit, [&](const DominanceFit& now) {
      objective.push_back(now.objective);
      return true;
    });
    EXPECT_GT(objective.size(), 2u);
    for (std::size_t i = 1; i < objective.size(); ++i) EXPECT_LT(objective[i], objective[i - 1]);
    return fit;
  };
  const DominanceFit one = run(1), three = run(3);
  EXPECT_EQ(one.dominance, three.dominance);
  EXPECT_EQ(one.base, three.base);
}

TEST(RefinedDominance, RecoversTheDominanceThatMadeTheData) {
  test::Uniform random(24);
  Problem problem(random, 4, 40);
  const auto truth = random_dominance(random, 5);
  std::vector<double> base(5 * kRefinedOrders * 4);
  for (double& v : base) v = random(-1, 1);
  for (const FitSentence& sentence : problem.speech.sentences) {
    const RefinedDesign design = make_refined_design(problem.data, sentence, truth);
    for (std::size_t i = 0; i < sentence.frames; ++i)
      for (std::size_t c = 0; c < 4; ++c) {
        double value = 0;
        for (const RefinedPart& part : design.frame(i))
          for (std::size_t m = 0; m < kRefinedOrders; ++m)
            value += part.weight * part.basis[m] * base[(part.phone * kRefinedOrders + m) * 4 + c];
        problem.data.target[(sentence.first_frame + i) * 4 + c] = value;
      }
  }
  DominanceOptions options;
  options.prior = 1e-4;
  options.ridge = 1e-4;
  options.max_steps = 60;
  options.tolerance = 1e-9;
  DominanceFit fit = start_dominance(problem.data, options);
  fit_dominance(problem.data, options, fit, [](const DominanceFit&) { return true; });
  for (std::size_t p = 0; p < 5; ++p) {
    EXPECT_NEAR(fit.dominance[p].left, truth[p].left, 0.03 * truth[p].left);
    EXPECT_NEAR(fit.dominance[p].right, truth[p].right, 0.03 * truth[p].right);
    // Strengths have no scale of their own: the prior sets it.
    EXPECT_NEAR(fit.dominance[p].strength / fit.dominance[0].strength,
                truth[p].strength / truth[0].strength, 0.03 * truth[p].strength);
  }
}

// ---- the method as a whole ----

TEST(Refined, ASentenceThatIsOffByAConstantTeachesTheSame) {
  auto sentences = test::planted(30);
  TrainOptions options;
  options.refined.ridge = 1;
  options.refined.offset_frames = 1e-2;
  options.refined.width_prior = 1e6;  // the same dominance, whatever the deviation of the controls
  const auto plain = train(sentences, options);
  for (std::size_t s = 0; s < sentences.size(); ++s)  // a third up, a third down
    for (double& v : sentences[s].signal.values) v += s % 3 == 0 ? 5.0 : s % 3 == 1 ? -5.0 : 0.0;
  const auto moved = train(sentences, options);
  ASSERT_TRUE(plain && moved);
  const auto a = synthesise(*plain, sentences[0].script),
             b = synthesise(*moved, sentences[0].script);
  double largest = 0, spread = 0;
  const auto& phones = sentences[0].script.phones;
  const double begin = phones[1].start + 0.1, end = phones.back().start - 0.1;
  for (std::size_t i = 1; i < a->frames(); ++i) {
    // Motion, as where zero is cannot be told, and away from rest, whose place has moved a little.
    if (a->time(i) < begin || a->time(i) > end) continue;
    for (std::size_t c = 0; c < 2; ++c) {
      largest = std::max(
          largest, std::abs((a->at(i, c) - a->at(i - 1, c)) - (b->at(i, c) - b->at(i - 1, c))));
      spread = std::max(spread, std::abs(a->at(i, c) - a->at(i - 1, c)));
    }
  }
  EXPECT_LT(largest, 0.01 * spread);
}

TEST(Refined, LearnsWhatNeighboursDo) {
  // The second control follows the phone before: only a term for neighbours can tell.
  auto sentences = test::planted(60);
  for (Utterance& u : sentences) {
    Signal& s = u.signal;
    for (std::size_t i = 0; i < s.frames(); ++i) {
      double value = 0;
      for (std::size_t p = 1; p < u.script.phones.size(); ++p)
        if (s.time(i) >= u.script.phones[p].start && s.time(i) < u.script.phones[p].end)
          value = u.script.phones[p - 1].label == "B" ? 1 : 0;
      s.at(i, 1) = value;
    }
  }
  const std::vector<Utterance> test(sentences.begin(), sentences.begin() + 10);
  sentences.erase(sentences.begin(), sentences.begin() + 10);
  const auto model = train(sentences, {});
  ASSERT_TRUE(model);
  double error = 0, power = 0;
  for (const Utterance& u : test) {
    SynthesisOptions options;
    options.rate = u.signal.rate;
    options.frames = u.signal.frames();
    const auto made = synthesise(*model, u.script, options);
    const auto speech = u.script.phones[1].start, end = u.script.phones.back().start;
    for (std::size_t i = 0; i < made->frames(); ++i) {
      if (made->time(i) < speech || made->time(i) > end) continue;
      error += std::pow(made->at(i, 1) - u.signal.at(i, 1), 2);
      power += std::pow(u.signal.at(i, 1) - model->controls[1].mean, 2);
    }
  }
  EXPECT_LT(error, 0.35 * power);
}

TEST(Refined, ChoosesRidgesByWhatIsHeldOut) {
  auto sentences = test::planted(40);
  TrainSummary clear, noisy;
  TrainOptions phones;  // which made these sentences, so that no ridge is needed
  phones.refined.terms = 1;
  ASSERT_TRUE(train(sentences, phones, &clear));
  test::Uniform random(8);
  for (Utterance& u : sentences)
    for (double& v : u.signal.values) v = random(-1, 1);
  ASSERT_TRUE(train(sentences, {}, &noisy));
  EXPECT_EQ(clear.ridge, 0.5);
  EXPECT_EQ(noisy.ridge, 2);
}

TEST(Refined, TheClockOfSpeechBeginsAnewBehindPauses) {
  SpeechClock clock;
  EXPECT_LT(clock.since(-0.3, 0, true), 0);
  EXPECT_EQ(clock.since(0, 0.5, false), 0);
  EXPECT_EQ(clock.since(0.5, 0.75, false), 0.5);
  EXPECT_LT(clock.since(0.75, 0.875, true), 0);  // too short to begin anew
  EXPECT_EQ(clock.since(0.875, 1, false), 0.875);
  EXPECT_LT(clock.since(1, 1.5, true), 0);
  EXPECT_EQ(clock.since(1.5, 1.75, false), 0);
  EXPECT_EQ(clock.since(2, 2.25, false), 0);  // nothing at all was between
}

TEST(Refined, TermsNameThePhonesThatTheyMean) {
  const std::vector<PhoneModel> phones = {
      {"IY", 10, 10, 0.1, 1}, {"M", 10, 1, 0.08, 1}, {"SIL", 10, 0, 0.3, 1}};
  Neighbourhood here;
  here.phone = 0;
  here.left = 1;
  here.right = 2;
  here.duration = 0.1 * std::exp(0.5);
  here.next_duration = 0.3 * std::exp(-2);
  here.since = 0.6;
  const auto uses = terms_of(phones, here);
  const auto use = [&](RefinedTerm term) { return uses[std::size_t(term)]; };
  EXPECT_EQ(use(RefinedTerm::kind_left).key, 1 * 256 + 1u);   // vowel, M
  EXPECT_EQ(use(RefinedTerm::kind_right).key, 1 * 256 + 2u);  // vowel, SIL
  EXPECT_EQ(use(RefinedTerm::between).key, 1 * 256 + 0u);     // lips, silence
  EXPECT_EQ(use(RefinedTerm::class_duration).key, 10u);
  EXPECT_NEAR(use(RefinedTerm::class_duration).scale, 0.5, 1e-12);
  EXPECT_EQ(use(RefinedTerm::left_duration).key, 1u);
  EXPECT_NEAR(use(RefinedTerm::left_duration).scale, 0.5, 1e-12);
  EXPECT_EQ(use(RefinedTerm::next_duration).key, 0u);
  EXPECT_EQ(use(RefinedTerm::next_duration).scale, -1);  // limited
  EXPECT_EQ(use(RefinedTerm::since).scale, 0.6);
  EXPECT_NEAR(use(RefinedTerm::onset).scale, std::exp(-2), 1e-12);
  here.since = 7;
  EXPECT_EQ(terms_of(phones, here)[std::size_t(RefinedTerm::since)].scale, kLongestSince);
  here.right = kRestContext;
  here.since = -1;
  const auto silent = terms_of(phones, here);
  for (const RefinedTerm none : {RefinedTerm::kind_right, RefinedTerm::next_duration,
                                 RefinedTerm::since, RefinedTerm::onset})
    EXPECT_EQ(silent[std::size_t(none)].scale, 0);
  // Renumbering changes the phone of a key and nothing else.
  const std::uint32_t key = use(RefinedTerm::kind_right).key;
  EXPECT_EQ(phone_of_key(RefinedTerm::kind_right, key), 2u);
  EXPECT_EQ(key_with_phone(RefinedTerm::kind_right, key, 7), 1 * 256 + 7u);
  EXPECT_EQ(phone_of_key(RefinedTerm::phone_left, 5 * 256 + 3), 5u);
  EXPECT_EQ(key_with_phone(RefinedTerm::phone_left, 5 * 256 + 3, 7), 7 * 256 + 3u);
  for (const RefinedTerm none :
       {RefinedTerm::between, RefinedTerm::class_duration, RefinedTerm::since})
    EXPECT_FALSE(phone_of_key(none, 0));
}

TEST(Refined, SharperMotionIsQuickerAndHoldsWhatLasts) {
  const auto model = train(test::planted(20));
  ASSERT_TRUE(model);
  Script script = test::planted(1)[0].script;
  const double end = script.phones.back().end;
  script.phones.push_back({end, end + 1, "AA", {}});  // longer than any
  SynthesisOptions options;
  options.closure = options.rest_at_ends = false;
  options.rate = {50, 1};
  double speed[3];
  std::vector<Signal> made;
  for (const int sharpness : {0, 1, 2}) {
    options.sharpness = sharpness;
    made.push_back(*synthesise(*model, script, options));
    double& sum = speed[sharpness] = 0;
    for (std::size_t i = 0; i + 1 < made.back().frames(); ++i)
      sum += std::pow(made.back().at(i + 1, 0) - made.back().at(i, 0), 2);
  }
  EXPECT_GT(speed[1], 1.05 * speed[0]);
  EXPECT_GT(speed[2], 1.05 * speed[1]);
  // In the middle of a sound that is held nothing is to be sharpened, and twice is twice.
  const auto middle = std::size_t((end + 0.5) * 50);
  EXPECT_NEAR(made[1].at(middle, 0), made[0].at(middle, 0), 1e-4);
  for (std::size_t i = 0; i < made[0].frames(); ++i)
    EXPECT_NEAR(made[2].at(i, 0) - made[0].at(i, 0), 2 * (made[1].at(i, 0) - made[0].at(i, 0)),
                1e-4);
}

// The same curve gains more speed as the width of the mouth than as the jaw.
TEST(Refined, ArticulatorsThatTrainingSlowsDownAreSharpenedMore) {
  auto model = train(test::planted(20));
  ASSERT_TRUE(model);
  const Script script = test::planted(1)[0].script;
  SynthesisOptions options;
  options.closure = options.rest_at_ends = false;
  options.rate = {50, 1};
  const auto added = [&](const char* name) {
    model->controls[0].name = name;
    options.sharpness = 0;
    const Signal plain = *synthesise(*model, script, options);
    options.sharpness = 1;
    const Signal sharp = *synthesise(*model, script, options);
    double sum = 0;
    for (std::size_t i = 0; i < plain.frames(); ++i)
      sum += std::abs(sharp.at(i, 0) - plain.at(i, 0));
    return sum;
  };
  const double other = added("tail"), jaw = added("fap3_open_jaw");
  EXPECT_GT(other, 0);
  EXPECT_GT(jaw, 0);
  EXPECT_LT(jaw, other);
  EXPECT_GT(added("fap6_stretch_l_cornerlip"), 2 * jaw);
  EXPECT_GT(added("fap12_raise_l_cornerlip"), 1.2 * jaw);
  EXPECT_NEAR(added("mouthStretchLeft"), added("fap54"), 1e-6 * other);
}

TEST(Refined, TriphonesAreThoseThatOccurOften) {
  TrainOptions options;
  const auto model = train(test::planted(30), options);
  ASSERT_TRUE(model);
  const auto& tables = std::get<RefinedParameters>(model->parameters).tables;
  ASSERT_EQ(tables.size(), kTermCount);
  const auto& keys = tables[std::size_t(RefinedTerm::triphone)].keys;
  EXPECT_GT(keys.size(), 5u);
  EXPECT_LE(keys.size(), kMostTriphones);
  options.refined.terms = kAllTerms & ~(1u << unsigned(RefinedTerm::triphone));
  const auto without = train(test::planted(30), options);
  ASSERT_TRUE(without);
  EXPECT_TRUE(std::get<RefinedParameters>(without->parameters)
                  .tables[std::size_t(RefinedTerm::triphone)]
                  .keys.empty());
  // Three sentences have hardly a triphone three times.
  const auto few = train(test::planted(3));
  ASSERT_TRUE(few);
  EXPECT_LT(std::get<RefinedParameters>(few->parameters)
                .tables[std::size_t(RefinedTerm::triphone)]
                .keys.size(),
            keys.size());
}

}  // namespace refined_test
}  // namespace animeme::dam
