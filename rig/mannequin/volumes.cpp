#include "rig/mannequin/detail/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tutu::rig {
namespace {

/// The smaller of two, rounded where they differ by less than k: lowest k / 4 below both.
double blend(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * h * h * k;
}

/// The larger of two, rounded alike.
double carve(double a, double b, double k) { return -blend(-a, -b, k); }

double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii) {
  const Vec3 q = (p - centre).cwiseQuotient(radii);
  const double k0 = q.norm(), k1 = q.cwiseQuotient(radii).norm();
  return k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -radii.minCoeff(); // f / |grad f| of f = k0^2 - k0
}

double round_cone(const Vec3& p, const Vec3& a, const Vec3& b, double ra, double rb) {
  const Vec3 ab = b - a;
  const double s = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - s * ab).norm() - (ra + s * (rb - ra));
}

/// One section of a loft, across its axis at s: an ellipse in two halves that meet at the widest place.
struct Station {
  double s;        ///< along the axis from its origin, m
  double u, v;     ///< centre of the section, m
  double ru;       ///< half width along u
  double rv, rv_b; ///< half depths along +v and -v
};

/// A tube through elliptic sections, with smooth profiles between them and ellipsoidal caps.
struct Loft {
  Vec3 origin, axis, u, v; ///< orthonormal axes
  double cap;              ///< how far a cap stands out, m
  std::span<const Station> stations;
};

Loft loft_between(const Vec3& a, const Vec3& b, const Vec3& about_u, double cap, std::span<const Station> stations) {
  const Vec3 axis = (b - a).normalized();
  const Vec3 u = (about_u - about_u.dot(axis) * axis).normalized();
  return {a, axis, u, u.cross(axis), cap, stations};
}

/// Cubic Hermite through the stations, slopes by finite differences over unequal steps.
Station section(std::span<const Station> stations, double s) {
  const int last = static_cast<int>(stations.size()) - 1;
  if (s <= stations[0].s) return stations[0];
  if (s >= stations[last].s) return stations[last];
  int i = 0;
  while (s > stations[i + 1].s) ++i;
  const Station &p0 = stations[std::max(i - 1, 0)], &p1 = stations[i], &p2 = stations[i + 1],
                &p3 = stations[std::min(i + 2, last)];
  const double h = p2.s - p1.s, t = (s - p1.s) / h;
  const double b2 = t * t * (3.0 - 2.0 * t), c1 = t * (1.0 - t) * (1.0 - t) * h, c2 = -t * t * (1.0 - t) * h;
  const auto at = [&](double Station::*x) {
    const double m1 = (p2.*x - p0.*x) / (p2.s - p0.s), m2 = (p3.*x - p1.*x) / (p3.s - p1.s);
    return p1.*x + b2 * (p2.*x - p1.*x) + c1 * m1 + c2 * m2;
  };
  return {s, at(&Station::u), at(&Station::v), at(&Station::ru), at(&Station::rv), at(&Station::rv_b)};
}

double loft(const Vec3& p, const Loft& loft) {
  const Vec3 d = p - loft.origin;
  const double s = d.dot(loft.axis), clamped = std::clamp(s, loft.stations.front().s, loft.stations.back().s);
  const Station here = section(loft.stations, clamped);
  const double v = d.dot(loft.v) - here.v;
  return ellipsoid({d.dot(loft.u) - here.u, v, s - clamped}, Vec3::Zero(),
                   {here.ru, v > 0.0 ? here.rv : here.rv_b, loft.cap});
}

Vec3 mirrored(const Vec3& p) { return {-p.x(), p.y(), p.z()}; }

// --- The trunk: along +Y, u = +X, v = +Z
// ----------------------------------------------------------------------------------

constexpr std::array<Station, 15> k_torso = {{
    {0.822, 0, -0.006, 0.075, 0.048, 0.052},
    {0.845, 0, -0.006, 0.120, 0.078, 0.084},
    {0.875, 0, -0.004, 0.147, 0.087, 0.098},
    {0.920, 0, -0.002, 0.149, 0.091, 0.096},
    {0.970, 0, -0.001, 0.137, 0.089, 0.084},
    {1.020, 0, 0.000, 0.122, 0.083, 0.070},
    {1.065, 0, 0.000, 0.114, 0.078, 0.067},
    {1.110, 0, -0.004, 0.116, 0.081, 0.072},
    {1.160, 0, -0.009, 0.124, 0.087, 0.079},
    {1.220, 0, -0.014, 0.133, 0.091, 0.086},
    {1.280, 0, -0.020, 0.139, 0.088, 0.089},
    {1.330, 0, -0.026, 0.138, 0.074, 0.083},
    {1.375, 0, -0.030, 0.120, 0.055, 0.066},
    {1.410, 0, -0.031, 0.082, 0.044, 0.050},
    {1.440, 0, -0.030, 0.048, 0.040, 0.044},
}};

constexpr std::array<Station, 5> k_neck = {{
    {0.000, 0, 0.000, 0.0570, 0.048, 0.050},
    {0.040, 0, 0.000, 0.0480, 0.047, 0.048},
    {0.080, 0, 0.000, 0.0450, 0.046, 0.047},
    {0.120, 0, 0.000, 0.0450, 0.047, 0.048},
    {0.160, 0, 0.000, 0.0455, 0.047, 0.050},
}};

double torso(const Vec3& p) {
  static const Loft k_loft = {Vec3::Zero(), Vec3::UnitY(), Vec3::UnitX(), Vec3::UnitZ(), 0.02, k_torso};
  static const Loft k_neck_loft = loft_between({0, 1.395, -0.036}, {0, 1.555, 0.002}, Vec3::UnitX(), 0.03, k_neck);
  double d = loft(p, k_loft);
  d = blend(d, loft(p, k_neck_loft), 0.03);
  d = blend(d, round_cone(p, {0.020, 1.436, -0.044}, {0.140, 1.386, -0.030}, 0.029, 0.019), 0.035); // trapezius
  d = blend(d, round_cone(p, {0.015, 1.400, 0.004}, {0.120, 1.405, -0.006}, 0.008, 0.008), 0.025);  // collar bone
  d = blend(d, ellipsoid(p, {0.076, 1.310, -0.082}, {0.044, 0.062, 0.027}), 0.04);                  // shoulder blade
  for (const Vec3& side : {p, mirrored(p)}) {
    d = blend(d, ellipsoid(side, {0.068, 1.228, 0.062}, {0.051, 0.050, 0.044}), 0.03);  // breast
    d = blend(d, ellipsoid(side, {0.064, 1.262, 0.046}, {0.042, 0.060, 0.030}), 0.035); // and above it
    d = blend(d, ellipsoid(side, {0.070, 0.868, -0.056}, {0.072, 0.080, 0.064}), 0.03); // buttock
  }
  return d;
}

double head(const Vec3& p) {
  double d = ellipsoid(p, {0, 1.614, -0.016}, {0.0720, 0.0860, 0.0910});            // cranium
  d = blend(d, ellipsoid(p, {0, 1.570, 0.022}, {0.0590, 0.0740, 0.0640}), 0.03);    // face
  d = blend(d, ellipsoid(p, {0, 1.513, 0.044}, {0.0330, 0.0240, 0.0330}), 0.03);    // chin
  d = carve(d, -ellipsoid(p, {0.033, 1.588, 0.100}, {0.023, 0.012, 0.021}), 0.022); // eye socket
  d = blend(d, ellipsoid(p, {0.032, 1.586, 0.0665}, {0.0130, 0.0100, 0.0130}), 0.008);
  d = blend(d, round_cone(p, {0, 1.594, 0.078}, {0, 1.565, 0.0915}, 0.0060, 0.0080), 0.016); // nose
  d = blend(d, ellipsoid(p, {0, 1.5365, 0.0780}, {0.0180, 0.0080, 0.0085}), 0.010);          // lips
  d = blend(d, ellipsoid(p, {0.0690, 1.582, -0.012}, {0.0090, 0.0240, 0.0150}), 0.010);      // ear
  return blend(d, ellipsoid(p, {0, 1.655, -0.106}, {0.0400, 0.0370, 0.0330}), 0.008);        // bun
}

double trunk(const Vec3& p) {
  const double d = torso(p);
  if (p.y() < 1.40) return d;
  return blend(d, head(p), 0.022);
}

// --- The leg: from hip to ankle, u = -X (to the other leg), v = +Z; the foot along +Z, u = +X, v = +Y
// --------------------------------------------

constexpr std::array<Station, 16> k_leg = {{
    {-0.030, 0.000, 0.000, 0.045, 0.050, 0.055},
    {0.015, 0.001, 0.002, 0.066, 0.072, 0.078},
    {0.060, 0.004, 0.003, 0.0775, 0.082, 0.086},
    {0.120, 0.006, 0.004, 0.0790, 0.081, 0.081},
    {0.200, 0.005, 0.006, 0.0705, 0.074, 0.071},
    {0.300, 0.002, 0.007, 0.0565, 0.062, 0.057},
    {0.370, 0.000, 0.005, 0.0475, 0.053, 0.049},
    {0.420, 0.000, 0.003, 0.0440, 0.049, 0.045},
    {0.465, -0.001, 0.001, 0.0415, 0.042, 0.047},
    {0.520, -0.002, -0.002, 0.0445, 0.040, 0.055},
    {0.570, -0.002, -0.004, 0.0450, 0.039, 0.057},
    {0.630, -0.001, -0.006, 0.0395, 0.036, 0.047},
    {0.700, 0.000, -0.006, 0.0300, 0.031, 0.034},
    {0.760, 0.000, -0.004, 0.0240, 0.027, 0.027},
    {0.795, 0.000, -0.002, 0.0235, 0.027, 0.026},
    {0.826, 0.000, 0.000, 0.0250, 0.028, 0.027},
}};

constexpr std::array<Station, 10> k_foot = {{
    {-0.072, 0.144, 0.030, 0.0200, 0.026, 0.028},
    {-0.050, 0.145, 0.036, 0.0245, 0.037, 0.042},
    {-0.020, 0.146, 0.038, 0.0255, 0.040, 0.045},
    {0.015, 0.148, 0.033, 0.0285, 0.040, 0.036},
    {0.050, 0.150, 0.025, 0.0325, 0.031, 0.028},
    {0.085, 0.152, 0.018, 0.0385, 0.023, 0.026},
    {0.105, 0.153, 0.014, 0.0390, 0.018, 0.022},
    {0.130, 0.152, 0.011, 0.0350, 0.014, 0.017},
    {0.150, 0.149, 0.009, 0.0300, 0.011, 0.013},
    {0.160, 0.147, 0.008, 0.0230, 0.009, 0.010},
}};

double leg(const Vec3& p) {
  static const Loft k_leg_loft =
      loft_between({0.0880, 0.9050, 0.0000}, {0.1456, 0.0810, -0.0280}, -Vec3::UnitX(), 0.02, k_leg);
  static const Loft k_foot_loft = {Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY(), 0.011, k_foot};
  double d = loft(p, k_leg_loft);
  if (p.y() < 0.62) {
    d = blend(d, ellipsoid(p, {0.1165, 0.492, 0.0250}, {0.022, 0.032, 0.0180}), 0.016); // kneecap
    double foot = loft(p, k_foot_loft);
    foot = blend(foot, ellipsoid(p, {0.163, 0.084, -0.034}, {0.007, 0.011, 0.010}), 0.012); // outer ankle
    foot = blend(foot, ellipsoid(p, {0.127, 0.090, -0.027}, {0.007, 0.011, 0.010}), 0.012); // inner ankle
    d = blend(d, foot, 0.03);
    d = carve(d, -p.y(), 0.006); // flat soles on the ground
  }
  return d;
}

// --- The arm: from shoulder to wrist, u = +Z (thumb), v = back of the hand
// --------------------------------------------------

constexpr std::array<Station, 12> k_arm = {{
    {-0.020, 0.000, 0.000, 0.038, 0.026, 0.036},
    {0.015, 0.000, 0.000, 0.043, 0.033, 0.043},
    {0.055, -0.003, 0.000, 0.0435, 0.038, 0.044},
    {0.105, -0.006, 0.000, 0.0400, 0.037, 0.041},
    {0.160, -0.010, 0.000, 0.0370, 0.034, 0.038},
    {0.220, -0.014, 0.000, 0.0345, 0.031, 0.034},
    {0.270, -0.015, 0.000, 0.0350, 0.030, 0.033},
    {0.310, -0.013, 0.000, 0.0360, 0.031, 0.033},
    {0.350, -0.010, 0.000, 0.0345, 0.030, 0.031},
    {0.420, -0.005, 0.000, 0.0280, 0.024, 0.025},
    {0.470, -0.002, 0.000, 0.0245, 0.0195, 0.020},
    {0.505, 0.000, 0.000, 0.0245, 0.0175, 0.018},
}};

constexpr std::array<Station, 5> k_palm = {{
    {0.000, 0.001, 0.0000, 0.0240, 0.0165, 0.0170},
    {0.025, 0.001, 0.0005, 0.0280, 0.0150, 0.0165},
    {0.050, -0.001, 0.0010, 0.0340, 0.0130, 0.0150},
    {0.075, -0.003, 0.0015, 0.0375, 0.0110, 0.0125},
    {0.090, -0.003, 0.0015, 0.0355, 0.0095, 0.0105},
}};

const Vec3 k_shoulder(0.1520, 1.3850, -0.0240), k_wrist(0.5263, 1.0480, -0.0054);

double arm(const Vec3& p) {
  static const Loft k_arm_loft = loft_between(k_shoulder, k_wrist, Vec3::UnitZ(), 0.03, k_arm);
  static const Loft k_palm_loft = loft_between(k_wrist, {0.5921, 0.9890, 0.0008}, Vec3::UnitZ(), 0.008, k_palm);
  const double d = loft(p, k_arm_loft);
  if (p.x() < 0.42) return d;
  double palm = loft(p, k_palm_loft);
  palm = blend(palm, round_cone(p, {0.5300, 1.0330, 0.0120}, {0.5500, 0.9990, 0.0400}, 0.0130, 0.0115),
               0.012); // ball of thumb
  return blend(d, palm, 0.012);
}

struct Finger {
  Vec3 knuckles[4]; ///< three joints and the tip
  double radii[4];
};

const Finger k_fingers[5] = {
    {{{0.5363, 1.0283, 0.0161}, {0.5505, 0.9981, 0.0432}, {0.5644, 0.9747, 0.0580}, {0.5766, 0.9568, 0.0662}},
     {0.0120, 0.0100, 0.0088, 0.0064}},
    {{{0.5901, 0.9932, 0.0260}, {0.6170, 0.9633, 0.0338}, {0.6306, 0.9428, 0.0384}, {0.6391, 0.9277, 0.0416}},
     {0.0084, 0.0077, 0.0068, 0.0052}},
    {{{0.5940, 0.9911, 0.0068}, {0.6222, 0.9562, 0.0110}, {0.6348, 0.9314, 0.0135}, {0.6411, 0.9137, 0.0152}},
     {0.0086, 0.0078, 0.0069, 0.0053}},
    {{{0.5914, 0.9921, -0.0130}, {0.6166, 0.9598, -0.0137}, {0.6285, 0.9355, -0.0141}, {0.6345, 0.9178, -0.0144}},
     {0.0083, 0.0074, 0.0066, 0.0051}},
    {{{0.5851, 0.9937, -0.0309}, {0.6064, 0.9691, -0.0360}, {0.6166, 0.9521, -0.0390}, {0.6230, 0.9375, -0.0411}},
     {0.0076, 0.0067, 0.0059, 0.0046}},
};

double finger(const Vec3& p, const Finger& f) {
  double d = round_cone(p, f.knuckles[0], f.knuckles[1], f.radii[0], f.radii[1]);
  for (int i = 1; i < 3; ++i)
    d = blend(d, round_cone(p, f.knuckles[i], f.knuckles[i + 1], f.radii[i], f.radii[i + 1]), 0.003);
  return d;
}

double arm_with_fingers(const Vec3& p) {
  const double d = arm(p);
  if (p.x() < 0.5) return d;
  double fingers = finger(p, k_fingers[0]);
  for (int i = 1; i < 5; ++i) fingers = blend(fingers, finger(p, k_fingers[i]), 0.006);
  return blend(d, fingers, 0.008);
}

} // namespace

double body_distance(const Vec3& p) {
  // Far from a limb its distance is left out: beyond the blend it would change nothing.
  double d = 1.0;
  if (p.y() > 0.65) d = trunk(p);
  if (p.y() < 1.05 && p.x() < 0.35) {
    double legs = leg(p);
    if (p.x() < 0.05 && p.y() > 0.5) legs = blend(legs, leg(mirrored(p)), 0.032);
    d = blend(d, legs, 0.036);
  }
  if (p.x() > 0.04 && p.y() > 0.8) d = blend(d, arm_with_fingers(p), 0.040);
  return d;
}

double chain_distance(BodyChain limb, const Vec3& p) {
  switch (limb) {
  case BodyChain::trunk: return trunk(p);
  case BodyChain::arm: return arm(p);
  case BodyChain::leg: return leg(p);
  default: return finger(p, k_fingers[static_cast<int>(limb) - static_cast<int>(BodyChain::thumb)]);
  }
}

double edge_length(const Vec3& p) {
  struct Spot {
    Vec3 centre;
    double radius, edge;
  };
  static const Spot k_spots[] = {
      {{0.045, 1.555, 0.070}, 0.060, 0.0075},  // face
      {{0.000, 1.565, 0.095}, 0.028, 0.0050},  // nose and lips
      {{0.072, 1.578, -0.014}, 0.025, 0.0070}, // ear
      {{0.000, 1.600, -0.010}, 0.130, 0.0120}, // head
      {{0.352, 1.204, -0.030}, 0.060, 0.0105}, // elbow
      {{0.526, 1.048, -0.005}, 0.040, 0.0090}, // wrist
      {{0.117, 0.486, 0.004}, 0.080, 0.0120},  // knee
      {{0.146, 0.081, -0.028}, 0.060, 0.0110}, // ankle
      {{0.151, 0.020, 0.110}, 0.060, 0.0090},  // toes
      {{0.050, 0.810, 0.000}, 0.060, 0.0120},  // crotch
      {{0.165, 1.330, -0.024}, 0.050, 0.0120}, // armpit
  };
  constexpr double k_growth = 0.30; // of the edge length, per length away from a spot
  double edge = 0.0155;
  for (const Spot& spot : k_spots)
    edge = std::min(edge, spot.edge + k_growth * std::max((p - spot.centre).norm() - spot.radius, 0.0));
  if (p.x() > 0.45) {
    for (const Finger& f : k_fingers) edge = std::min(edge, 0.0040 + k_growth * std::max(finger(p, f), 0.0));
    edge = std::min(edge, 0.0068 + k_growth * std::max(arm(p) + std::max(0.53 - p.x(), 0.0), 0.0));
  }
  return edge;
}

} // namespace tutu::rig
