#include "solver/loop/neighbour_search.hpp"

#include "solver/loop/cell_grid.hpp"
#include "solver/loop/plane_sweep.hpp"

namespace slurry {

std::unique_ptr<NeighbourFinder> make_finder(NeighbourSearch search, const SearchProblem& problem) {
    if (search == NeighbourSearch::plane_sweep) {
        return std::make_unique<PlaneSweep>(problem);
    }
    constexpr int columns_of_strips = 6;
    return std::make_unique<CellGrid>(problem, search == NeighbourSearch::strips ? columns_of_strips : 1);
}

} // namespace slurry
