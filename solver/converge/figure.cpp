// The figure of a convergence study; SVG, because it needs no library.
#include "solver/converge/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slurry {
namespace {

constexpr int columns = 4;
constexpr double panel_width = 260, panel_height = 200; // pixels, with everything around the axes
constexpr double left = 64, right = 10, top = 38, bottom = 36;

// The fit of a quantity that converges: limit + a spacing^order, through the value at the finest spacing.
double fitted(const Assessment& quantity, double spacing) {
    const Estimate& fit = quantity.spacing;
    return fit.extrapolated + (quantity.finest() - fit.extrapolated) *
                                  std::pow(spacing / quantity.values.back().spacing, fit.order_used);
}

// From data to pixels in a panel; everything that is drawn lies between low() and high().
class Axes {
  public:
    Axes(const Assessment& quantity, std::size_t index)
        : x0_(static_cast<double>(index % columns) * panel_width),
          y0_(panel_height * std::floor(static_cast<double>(index) / columns)),
          most_spacing_(1.05 * quantity.values.front().spacing) {
        for (const GridValue& at : quantity.values) {
            include(at.value);
        }
        for (const double value : {quantity.finest() - quantity.band(), quantity.finest() + quantity.band(),
                                   quantity.extrapolated(), quantity.spacing.extrapolated,
                                   quantity.stiffer ? quantity.stiffer->value : quantity.finest(),
                                   fitted(quantity, quantity.values.front().spacing)}) {
            if (std::isfinite(value)) {
                include(value);
            }
        }
        const double margin = std::max(0.06 * (high_ - low_), 1e-6 * std::abs(high_) + 1e-300);
        low_ -= margin;
        high_ += margin;
    }

    [[nodiscard]] double x(double spacing) const {
        return x0_ + left + spacing / most_spacing_ * (panel_width - left - right);
    }
    [[nodiscard]] double y(double value) const {
        return y0_ + panel_height - bottom - (value - low_) / (high_ - low_) * (panel_height - top - bottom);
    }
    [[nodiscard]] double low() const { return low_; }
    [[nodiscard]] double high() const { return high_; }
    [[nodiscard]] double most_spacing() const { return most_spacing_; }
    [[nodiscard]] double title_y() const { return y0_ + 16; }

  private:
    void include(double value) {
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }

    double x0_, y0_, most_spacing_;
    double low_ = INFINITY, high_ = -INFINITY;
};

std::string text(double x, double y, std::string_view anchor, const std::string& words, int size = 10) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>\n", x,
                       y, anchor, size, words);
}

std::string circle(double x, double y, std::string_view style) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" {}/>\n", x, y, style);
}

std::string frame(const Axes& axes, const Assessment& quantity) {
    const double x0 = axes.x(0), x1 = axes.x(axes.most_spacing());
    std::string svg =
        fmt::format("<path d=\"M{0:.1f} {2:.1f}V{3:.1f}H{1:.1f}\" fill=\"none\" stroke=\"black\"/>\n", x0, x1,
                    axes.y(axes.high()), axes.y(axes.low()));
    svg += text(x0 - 50, axes.title_y(), "start",
                fmt::format("{} {} ({})", quantity.place, quantity.name, quantity.unit), 12);
    const Estimate& estimate = quantity.spacing;
    svg += text(x0 - 50, axes.title_y() + 13, "start",
                std::isnan(estimate.order)
                    ? std::string(verdict_name(estimate.verdict))
                    : fmt::format("{}, order {:.1f}", verdict_name(estimate.verdict), estimate.order));
    for (const double share : {0.1, 0.5, 0.9}) {
        const double value = std::lerp(axes.low(), axes.high(), share);
        svg += text(x0 - 4, axes.y(value) + 3, "end", fmt::format("{:.4g}", value));
    }
    svg += text(x0, axes.y(axes.low()) + 13, "middle", "0");
    for (const double spacing : {quantity.values.front().spacing, quantity.values.back().spacing}) {
        svg += text(axes.x(spacing), axes.y(axes.low()) + 13, "middle", fmt::format("{:.3g}", spacing));
    }
    return svg + text((x0 + x1) / 2, axes.y(axes.low()) + 27, "middle", "particle spacing (m)");
}

std::string curve(const Axes& axes, const Assessment& quantity) {
    if (quantity.spacing.verdict != Verdict::converging) {
        return {};
    }
    std::string path;
    constexpr int points = 40;
    for (int k = 0; k <= points; ++k) {
        const double spacing = quantity.values.front().spacing * k / points;
        path += fmt::format("{}{:.1f} {:.1f}", k == 0 ? "M" : "L", axes.x(spacing),
                            axes.y(fitted(quantity, spacing)));
    }
    return fmt::format(R"(<path d="{}" fill="none" stroke="#0072b2"/>)", path) +
           circle(axes.x(0), axes.y(quantity.extrapolated()), R"(fill="white" stroke="#0072b2")");
}

std::string band(const Axes& axes, const Assessment& quantity) {
    if (std::isnan(quantity.band())) {
        return {};
    }
    const double x0 = axes.x(0), y0 = axes.y(quantity.finest() + quantity.band());
    return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#e69f00\" "
                       "fill-opacity=\"0.3\"/>\n",
                       x0, y0, axes.x(quantity.values.back().spacing) - x0,
                       axes.y(quantity.finest() - quantity.band()) - y0);
}

std::string panel(const Assessment& quantity, std::size_t index) {
    const Axes axes(quantity, index);
    std::string svg = band(axes, quantity) + frame(axes, quantity) + curve(axes, quantity);
    if (quantity.stiffer) {
        svg += circle(axes.x(quantity.values[quantity.values.size() - 2].spacing),
                      axes.y(quantity.stiffer->value), R"(fill="none" stroke="#d55e00")");
    }
    for (const GridValue& at : quantity.values) {
        svg += circle(axes.x(at.spacing), axes.y(at.value), R"(fill="black")");
    }
    return svg;
}

} // namespace

std::string study_svg(const Study& study) {
    const std::size_t rows = (study.quantities.size() + columns - 1) / columns;
    const double width = columns * panel_width, height = static_cast<double>(rows) * panel_height;
    std::string svg =
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
                    "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                    width, height + 24);
    for (std::size_t index = 0; index < study.quantities.size(); ++index) {
        svg += panel(study.quantities[index], index);
    }
    svg += text(14, height + 12, "start",
                "filled: runs; shaded: band about the finest; blue: fit and what it extrapolates to, with an "
                "infinite "
                "sound speed; red ring: twice the sound speed",
                11);
    return svg + "</svg>\n";
}

} // namespace slurry
