-- The middle one of three books that fill a shelf: a millimetre of air on each side, a wall behind. Only
-- its spine, the front, and its top can be touched; a hand gets hold of it when it is tipped or pulled out.
local function book(name, y)
  return { name = name, shape = box{0.155, 0.030, 0.230}, mass = 0.6, friction = 0.3, p = {-0.0875, y, 0.115} }
end

return scene {
  name = "book",
  object = book("book", 0),
  environment = {
    -- The spines stand 1 cm behind the shelf's front edge, which is x = 0; its top is z = 0.
    { name = "shelf", shape = box{0.200, 0.400, 0.020}, friction = 0.3, p = {-0.100, 0, -0.010} },
    { name = "top", shape = box{0.200, 0.400, 0.020}, friction = 0.3, p = {-0.100, 0, 0.300} },
    { name = "back", shape = box{0.020, 0.400, 0.330}, friction = 0.3, p = {-0.180, 0, 0.145} },
    book("left_book", -0.031),
    book("right_book", 0.031),
    { name = "left_end", shape = box{0.150, 0.020, 0.230}, friction = 0.3, p = {-0.0875, -0.057, 0.115} },
    { name = "right_end", shape = box{0.150, 0.020, 0.230}, friction = 0.3, p = {-0.0875, 0.057, 0.115} },
  },
}
