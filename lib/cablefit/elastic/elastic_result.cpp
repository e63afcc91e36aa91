#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

const ElasticFit* ElasticPreload::find(const std::string& model) const {
  for (const ElasticFit& fit : fits)
    if (fit.model == model) return &fit;
  return nullptr;
}

}  // namespace cablefit
